// Frames of a PROFIBUS line as messages and numbers, and who sends what a test says.
#include "runtime/station/profibus_bus.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/plant_file/profibus_paper.hpp"
#include "runtime/station/octet_faults.hpp"
#include "runtime/station/profibus_octets.hpp"

namespace ipos::runtime {

class ProfibusBus::Hand final : public profibus::Node {
 public:
  explicit Hand(profibus::Line& line) : line_(line), node_(line.attach("test", *this)) {}
  bool send(profibus::Octets octets) { return line_.send(node_, 0, std::move(octets)); }

 private:
  void on_reception(Time, const profibus::Reception&) override {}
  void on_sent(Time) override {}

  profibus::Line& line_;
  NodeId node_;
};

ProfibusBus::ProfibusBus(BusPlace place)
    : Bus(place.config), place_(std::move(place)), line_(place_.queue, place_.source, name(), baud()) {
  line_.add_observer(*this);
}

ProfibusBus::~ProfibusBus() = default;

std::optional<std::string> ProfibusBus::refuse(const std::string& text) {
  if (parse_octets(text)) return std::nullopt;
  return fmt::format("'{}' are no octets; write for example \"10 08 02 49 fcs 16\"", text);
}

void ProfibusBus::attach_hand() {
  if (!hand_) hand_ = std::make_unique<Hand>(line_);
}

std::optional<std::string> ProfibusBus::send(const std::string& text) {
  if (hand_->send(*parse_octets(text))) return std::nullopt;
  return "the frame before is still being sent";
}

FmsOperator& ProfibusBus::fms_operator(const std::set<uint8_t>& taken) {
  uint8_t address = 1;
  while (taken.contains(address)) ++address;
  if (!fms_operator_) fms_operator_ = std::make_unique<FmsOperator>(place_.queue, place_.source, line_, address);
  return *fms_operator_;
}

std::vector<std::string> ProfibusBus::findings(const PlantFile& file) const {
  std::vector<std::string> texts = check_line(profibus_paper(file, config()));
  for (std::string& text : profibus_master_findings(file, config())) texts.push_back(std::move(text));
  for (std::string& text : profibus_wear_findings(file, config())) texts.push_back(std::move(text));
  return texts;
}

std::vector<FaultRule> ProfibusBus::fault_rules() const {
  return octet_fault_rules(OctetLine::Profibus);
}

FaultConfig ProfibusBus::make_fault(const WantedFault& wanted) const {
  return make_octet_fault(wanted, OctetLine::Profibus);
}

bool ProfibusBus::plant(const FaultConfig& config) {
  return plant_octet_fault(line_, config);
}

bool ProfibusBus::repair(const FaultConfig& config) {
  return line_.end_fault(config.octets->kind, node_named(line_, config.station));
}

void ProfibusBus::on_frame(const profibus::Line&, NodeId sender, const profibus::Reception& reception) {
  if (!watched_) return;
  facts_ = {sender, static_cast<uint64_t>(reception.start), static_cast<uint64_t>(reception.end),
            reception.frame ? 0 : 1 + static_cast<uint64_t>(reception.frame.error())};
  facts_.insert(facts_.end(), reception.octets.begin(), reception.octets.end());
  trace(facts_);
  if (!is_observed()) return;
  tell({reception.end, profibus::hex_text(reception.octets),
        reception.frame ? profibus::describe(*reception.frame)
                        : "void: " + std::string(profibus::frame_error_text(reception.frame.error())),
        reception.octets});
}

void ProfibusBus::on_line_event(const profibus::Line& line, const profibus::LineEvent& event) {
  if (told_.emplace(event.kind, event.node, event.fault).second)
    place_.warn(event.time, describe(line, event));
  trace_all(event.kind, event.time, event.node);
}

IPOS_MAKES_BUS(ProfibusBus)

}  // namespace ipos::runtime
