// Frames and telegrams at which a plant stops while time goes on: after the millisecond in which one came that looks so.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

class FramePoints final : private runtime::BusObserver {
 public:
  using Point = std::pair<int, std::string>;  // id; pattern of a text, also after the name of its bus

  // Whether a frame or telegram of a bus of the plant can look so: "40A#80*", "sbus1 40A#*", the bytes of a telegram.
  static bool is_frame(const runtime::Plant& plant, std::string_view pattern);

  void built(runtime::Plant& plant);  // listens to its buses
  void add(int id, std::string pattern) { points_.emplace_back(id, std::move(pattern)); }
  bool remove(int id);
  void clear() { points_.clear(); }
  const std::vector<Point>& all() const { return points_; }

  // A run begins. What comes while time goes back has been seen before.
  void listen(bool forward);
  bool has_seen() const { return !seen_.empty(); }
  int id() const { return id_; }
  const std::string& text() const { return seen_; }  // "40A#0000 on sbus"

  Json save() const { return points_; }
  void load(const Json& points) { points_ = points.get<std::vector<Point>>(); }

 private:
  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override;

  std::vector<Point> points_;
  bool forward_ = false;
  int id_ = 0;
  std::string seen_;  // empty: none has come
};

}  // namespace ipos::tools::debug
