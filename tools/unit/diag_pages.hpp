// The five diagnostic pages of a unit on its buses: parameters, process data, RS-485, CAN, fieldbus (11264926 chapters
// 8.8 and 9 name them; what stands on them is ours). What goes over the lines is listened to while the plant runs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/words/can_words.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::tools {

class DiagPages final : private runtime::CanObserver {
 public:
  static constexpr const char* kNames[] = {"parameters", "pd", "rs485", "can", "fieldbus"};

  // The plant is fresh; names are those of its station after a moment (can_names).
  DiagPages(runtime::Plant& plant, runtime::Station& station, runtime::CanNames names);

  // As it is now. `page` is one of kNames.
  std::string page(const std::string& page);

  // The only page of a gateway.
  static std::string gateway(runtime::Gateway& gateway, runtime::Time now);

 private:
  struct Heard {
    uint64_t sent = 0, received = 0;
    std::string last_parameter;  // in words
    uint64_t parameters = 0;
  };

  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override;
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}

  std::string parameters() const;
  std::string process_data() const;
  std::string rs485() const;
  std::string can() const;
  std::string fieldbus() const;
  std::string row(std::string_view number) const;  // "P881 Address SBus 1  3"; empty where the unit has none
  bool concerns(const runtime::CanLine& line, const runtime::Frame& frame) const;

  runtime::Plant& plant_;
  runtime::Station& station_;
  runtime::CanWords words_;
  std::map<const runtime::CanLine*, Heard> heard_;
};

}  // namespace ipos::tools
