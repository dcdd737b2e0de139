// Frames and telegrams at which a plant stops while time goes on: after the millisecond in which one came that looks so.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

struct FramePoint {
  int id = 0;
  std::string pattern;        // of a text, also after the name of its bus
  std::string condition{};      // as of a breakpoint, names of the first station
  std::string hit_condition{};  // as of a breakpoint
  bool enabled = true;
  uint64_t hits = 0;

  NLOHMANN_DEFINE_TYPE_INTRUSIVE(FramePoint, id, pattern, condition, hit_condition, enabled, hits)
};

class FramePoints final : private runtime::BusObserver {
 public:
  // Whether a frame or telegram of a bus of the plant can look so: "40A#80*", "sbus1 40A#*", the bytes of a telegram.
  static bool is_frame(const runtime::Plant& plant, std::string_view pattern);

  void built(runtime::Plant& plant);  // listens to its buses
  void add(FramePoint point) { points_.push_back(std::move(point)); }
  bool remove(int id);
  void clear() { points_.clear(); }
  std::vector<FramePoint>& all() { return points_; }
  const std::vector<FramePoint>& all() const { return points_; }

  // A run begins. What comes while time goes back has been seen before.
  void listen(bool forward);
  bool has_seen() const { return !seen_.empty(); }
  int id() const { return id_; }
  const std::string& text() const { return seen_; }  // "40A#0000 on sbus", and what is wrong with a condition

  Json save() const { return points_; }
  void load(const Json& points) { points_ = points.get<std::vector<FramePoint>>(); }

 private:
  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override;

  std::vector<FramePoint> points_;
  const runtime::Plant* plant_ = nullptr;
  bool forward_ = false;
  int id_ = 0;
  std::string seen_;  // empty: none has come
};

}  // namespace ipos::tools::debug
