// Telegrams from hop to hop.
#include "tests/runtime/bus/toy/ring_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/plant_file/bytes_text.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kSentOctets = 2;        // address and value
constexpr uint32_t kHopBits = 30;        // of a telegram
constexpr uint32_t kLongestRing = 100'000;   // mm

}  // namespace

class RingBus::Hand final : public RingNode {
 public:
  explicit Hand(RingBus& ring) : node(ring.attach("test", *this)) {}
  void on_telegram(Time, const RingTelegram&) override {}
  const NodeId node;
};

RingBus::RingBus(BusPlace place) : Bus(place.config), place_(std::move(place)), meter_(baud()) {}

RingBus::~RingBus() { place_.queue.cancel_all(*this); }

std::optional<std::string> RingBus::refuse(const std::string& text) {
  if (const auto octets = parse_bytes(text); octets && octets->size() == kSentOctets) return std::nullopt;
  return fmt::format("'{}' is no address and value; write for example \"02 1E\"", text);
}

LineLoad RingBus::load(Time now) const {
  LineLoad load = meter_.load(static_cast<uint64_t>(now) * baud() / kSecond);
  load.frames = ended_;
  return load;
}

std::vector<std::string> RingBus::findings(const PlantFile&) const {
  if (config().length_mm <= kLongestRing) return {};
  return {fmt::format("a ring has at most {} m", kLongestRing / 1000)};
}

void RingBus::attach_hand() {
  if (!hand_) hand_ = std::make_unique<Hand>(*this);
}

std::optional<std::string> RingBus::send(const std::string& text) {
  const auto octets = *parse_bytes(text);
  send(hand_->node, octets[0], octets[1]);
  return std::nullopt;
}

std::vector<FaultRule> RingBus::fault_rules() const {
  return {{"cut", "telegrams end at the station", FaultPlace::Station, false, false}};
}

FaultConfig RingBus::make_fault(const WantedFault& wanted) const {
  FaultConfig config;
  config.fault.kind = FaultKind::Cut;
  config.fault.from = wanted.from;
  return config;
}

bool RingBus::plant(const FaultConfig& config) {
  if (std::find(names_.begin(), names_.end(), config.station) == names_.end()) return false;
  cut_ = config;
  return true;
}

NodeId RingBus::attach(std::string name, RingNode& node) {
  names_.push_back(std::move(name));
  nodes_.push_back(&node);
  return static_cast<NodeId>(nodes_.size() - 1);
}

void RingBus::send(NodeId from, uint8_t to, uint8_t value) {
  waiting_.push_back({static_cast<uint8_t>(from), to, value});
  if (waiting_.size() == 1) begin();
}

void RingBus::begin() {
  const auto next = static_cast<uint32_t>((waiting_.front().from + 1U) % nodes_.size());
  place_.queue.schedule(place_.queue.now() + hop(), place_.source, *this, next);
}

void RingBus::on_event(Time now, uint32_t node, uint64_t) {
  meter_.add(static_cast<uint64_t>(now - hop()) * baud() / kSecond, kHopBits);
  const RingTelegram telegram = waiting_.front();
  if (cut_ && cut_->station == names_[node] && cut_->fault.from <= now && now < cut_->fault.until)
    return end(now, fmt::format("lost at {}", names_[node]));
  if (node == telegram.to) {
    arrived_[telegram.to] = {telegram, arrived_[telegram.to].count + 1};
    nodes_[node]->on_telegram(now, telegram);
    return end(now, fmt::format("{} to {}: {}", names_[telegram.from], names_[node], telegram.value));
  }
  if (node == telegram.from) {
    place_.warn(now, fmt::format("{}: nobody has address {}", name(), telegram.to));
    return end(now, "back again");
  }
  place_.queue.schedule(now + hop(), place_.source, *this, static_cast<uint32_t>((node + 1) % nodes_.size()));
}

void RingBus::end(Time now, std::string meaning) {
  const RingTelegram telegram = waiting_.front();
  ++ended_;
  trace_all(telegram.from, telegram.to, telegram.value, now);
  if (is_observed())
    tell({now, fmt::format("{:02X} {:02X} {:02X}", telegram.from, telegram.to, telegram.value),
          std::move(meaning), {telegram.from, telegram.to, telegram.value}, {}});
  waiting_.pop_front();
  if (!waiting_.empty()) begin();
}

IPOS_MAKES_BUS(RingBus)

}  // namespace ipos::runtime
