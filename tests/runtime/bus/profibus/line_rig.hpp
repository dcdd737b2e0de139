// A line with slave stations, masters and an observer that keeps what it heard.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/bus/profibus/master.hpp"
#include "runtime/bus/profibus/slave_station.hpp"
#include "tests/runtime/bus/profibus/slave_rig.hpp"

namespace ipos::tests {

struct Heard {
  NodeId sender;
  Reception reception;
  std::string text() const { return text_of(reception.octets); }
};

class Recorder final : public LineObserver {
 public:
  void on_frame(const Line&, NodeId sender, const Reception& reception) override {
    if (keep) heard.push_back({sender, reception});
    ++frames;
    errors += !reception.frame.has_value();
  }
  void on_line_event(const Line& line, const LineEvent& event) override {
    events.push_back(event);
    texts.push_back(describe(line, event));
  }
  bool keep = true;
  std::vector<Heard> heard;
  uint64_t frames = 0, errors = 0;
  std::vector<LineEvent> events;
  std::vector<std::string> texts;
};

struct LineRig {
  explicit LineRig(uint32_t baud = 500'000) : line(queue, 0, "dp", baud) { line.add_observer(recorder); }

  struct Station {
    Station(LineRig& rig, uint8_t address, OptionKind kind)
        : station(rig.queue, rig.next_source++, rig.line, "slave" + std::to_string(address),
                  option_type(kind), {address}, unit, &notes) {}
    FakeUnit unit;
    Notes notes;
    SlaveStation station;
    DpSlave& slave() { return station.slave(); }
  };
  Station& add_slave(uint8_t address, OptionKind kind = OptionKind::Ffp31) {
    return stations.emplace_back(*this, address, kind);
  }
  Master& add_master(MasterSettings settings, MasterClient* client = nullptr) {
    masters.push_back(std::make_unique<Master>(
        queue, next_source++, line, "master" + std::to_string(settings.address), settings, client));
    return *masters.back();
  }
  void run(Time time) { queue.run_until(queue.now() + time); }

  runtime::EventQueue queue;
  Line line;
  Recorder recorder;
  uint32_t next_source = 1;
  std::deque<Station> stations;
  std::vector<std::unique_ptr<Master>> masters;
};

// The unit as a master's configuration has it; `octets` in each direction.
inline SlavePlan plan_of(uint8_t address, const std::string& cfg, uint8_t octets,
                         const std::string& parameters = "B0 00 00 0B 31 00 00") {
  return {address, *decode_prm(hex(parameters)), hex(cfg), octets, octets};
}

}  // namespace ipos::tests
