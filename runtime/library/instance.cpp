// Actions, one by one.
#include "runtime/library/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "runtime/station/dp_slaves.hpp"

namespace ipos::library {
namespace {

const std::string_view kStrange = "this plant has nothing of the kind";

constexpr size_t kFmsHead = 5;    // address, connection, service, index
constexpr size_t kFrameHead = 6;  // identifier, extended and remote, length

}  // namespace

std::vector<uint8_t> frame_bytes(const runtime::Frame& frame) {
  std::vector<uint8_t> bytes;
  for (int n = 0; n < 4; ++n) bytes.push_back(static_cast<uint8_t>(frame.id >> (8 * n)));
  bytes.push_back(static_cast<uint8_t>((frame.extended ? 1 : 0) | (frame.remote ? 2 : 0)));
  bytes.push_back(frame.length);
  bytes.insert(bytes.end(), frame.data.begin(), frame.data.end());
  return bytes;
}

std::optional<runtime::Frame> frame_of(std::span<const uint8_t> bytes) {
  runtime::Frame frame;
  if (bytes.size() != kFrameHead + frame.data.size()) return std::nullopt;
  for (size_t n = 0; n < 4; ++n) frame.id |= uint32_t{bytes[n]} << (8 * n);
  frame.extended = (bytes[4] & 1U) != 0;
  frame.remote = (bytes[4] & 2U) != 0;
  frame.length = bytes[5];
  std::copy(bytes.begin() + kFrameHead, bytes.end(), frame.data.begin());
  return runtime::is_valid(frame) ? std::optional(runtime::canonical(frame)) : std::nullopt;
}

Instance::Instance(std::unique_ptr<runtime::Plant> plant) : plant_(std::move(plant)), actions_(*plant_, "the library") {
  for (const auto& bus : plant_->buses())
    runtime::visit(
        *bus, [this](runtime::CanBus& can) { can_.push_back(std::make_unique<CanTap>(can.line())); },
        [this](runtime::SerialBus& serial) { serial_.push_back(std::make_unique<SerialTap>(serial.line())); },
        [this](runtime::ProfibusBus& dp) { profibus_.push_back(std::make_unique<ProfibusTap>(dp.line())); });
  nodes_.resize(can_.size());
}

Refusal Instance::touch(const Action& action) {
  const auto signal = signal_of(*plant_, action.signal);
  if (!signal || signal->put == nullptr) return std::string(kStrange);
  if (auto refused = signal->check(action.value)) return refused;
  if (action.act == Act::Write) return actions_.set(*signal, action.value);
  if (action.act == Act::Force) return actions_.force(*signal, action.value);
  actions_.release(*signal);
  return std::nullopt;
}

Refusal Instance::send(const Action& action) {
  if (action.act == Act::SerialSend) {
    Refusal refused = std::string(kStrange);
    with_line(action.number, [&](auto& tap) {
      if constexpr (requires { tap.send(std::span(action.bytes)); })
        if (!action.bytes.empty() && action.bytes.size() <= tap.kLongest) refused = tap.send(action.bytes);
    });
    return refused;
  }
  if (action.number >= can_.size()) return std::string(kStrange);
  if (action.act == Act::Join) {
    can_[action.number]->join();
    return std::nullopt;
  }
  const auto frame = frame_of(action.bytes);
  if (!frame) return std::string(kStrange);
  return can_[action.number]->send(*frame, static_cast<uint32_t>(action.value));
}

Refusal Instance::tell_node(const Action& action) {
  if (action.number >= can_.size()) return std::string(kStrange);
  std::unique_ptr<CanNodes>& nodes = nodes_[action.number];
  if (action.act == Act::NodesJoin) {
    if (nodes || action.value < 1 || action.value > static_cast<int64_t>(CanNodes::kMost)) return std::string(kStrange);
    nodes = std::make_unique<CanNodes>(can_[action.number]->line(), static_cast<size_t>(action.value));
    return std::nullopt;
  }
  const size_t node = action.signal.number;
  if (!nodes || node >= nodes->count()) return std::string(kStrange);
  switch (action.act) {
    case Act::NodeSend: {
      const auto frame = frame_of(action.bytes);
      return frame ? nodes->send(plant_->now(), node, *frame) : std::string(kStrange);
    }
    case Act::NodeRate: return nodes->set_rate(node, action.value);
    case Act::NodeState:
      if (action.value < 0 || action.value > static_cast<int64_t>(runtime::ErrorState::BusOff)) return std::string(kStrange);
      nodes->set_state(node, static_cast<runtime::ErrorState>(action.value));
      break;
    default: nodes->set_discards(node, action.value != 0); break;
  }
  return std::nullopt;
}

runtime::FmsOperator* Instance::fms(uint32_t line) {
  runtime::FmsOperator* found = nullptr;
  with_line(line, [&](auto& tap) {
    if (auto* const bus = runtime::as<runtime::ProfibusBus>(plant_->find_bus(tap.line().name())))
      found = &runtime::fms_operator_of(*plant_, *bus);
  });
  return found;
}

// Answers to what was asked before and was not taken are gone.
Refusal Instance::ask_fms(const Action& action) {
  namespace fms = profibus::fms;
  const std::span<const uint8_t> bytes = action.bytes;
  if (bytes.size() < kFmsHead || bytes[2] >= fms::service_types().size()) return std::string(kStrange);
  const fms::Connection* connection = fms::find_connection(bytes[1]);
  runtime::FmsOperator* const hand = this->fms(action.number);
  if (connection == nullptr || hand == nullptr) return std::string(kStrange);
  while (hand->take()) continue;
  const std::span<const uint8_t> data = bytes.subspan(kFmsHead);
  hand->ask(bytes[0], *connection,
            {static_cast<fms::Service>(bytes[2]), static_cast<uint16_t>(bytes[3] << 8 | bytes[4]), {data.begin(), data.end()}});
  return std::nullopt;
}

Refusal Instance::plant_faults(const Action& action) {
  const std::string text(action.bytes.begin(), action.bytes.end());
  runtime::PlantFileResult read = runtime::read_fault_tables(text, plant_->file());
  if (!read.errors.empty())
    return fmt::format("line {}, column {}: {}", read.errors.front().place.line,
                       read.errors.front().place.column, read.errors.front().text);
  for (runtime::FaultConfig& fault : read.plant.faults)
    if (auto refused = actions_.plant_fault(fault, plant_->now())) return refused;
  return std::nullopt;
}

Refusal Instance::perform(const Action& action) {
  switch (action.act) {
    case Act::Write:
    case Act::Force:
    case Act::Release: return touch(action);
    case Act::Join:
    case Act::Send:
    case Act::SerialSend: return send(action);
    case Act::LineFault: return plant_faults(action);
    case Act::NodesJoin:
    case Act::NodeSend:
    case Act::NodeRate:
    case Act::NodeState:
    case Act::NodeDiscards: return tell_node(action);
    case Act::Fms: return ask_fms(action);
    default: break;
  }
  if (const runtime::Gateway* gateway = gateway_of(*plant_, action.signal.station)) {
    if (action.act != Act::PowerOff && action.act != Act::PowerOn)
      return fmt::format("'{}' is a gateway: it has no program and no drive", gateway->config().name);
    plant_->set_power(gateway->config().name, action.act == Act::PowerOn);
    return std::nullopt;
  }
  if (action.signal.station >= plant_->stations().size()) return std::string(kStrange);
  Station& station = *plant_->stations()[action.signal.station];
  switch (action.act) {
    case Act::PowerOff:
    case Act::PowerOn: plant_->set_power(station.config().name, action.act == Act::PowerOn); break;
    case Act::DriveFault:
      if (action.value < 1 || action.value > UINT8_MAX) return "a drive fault is 1..255";
      station.drive().state().raise_fault(static_cast<uint8_t>(action.value));
      break;
    case Act::ResetFault: station.drive().state().reset_fault(); break;
    case Act::Program:
      if (action.value < 0 || action.value > static_cast<int64_t>(runtime::ProgramOrder::Restart))
        return std::string(kStrange);
      return runtime::PlantActions::order(station, static_cast<runtime::ProgramOrder>(action.value));
    default: break;
  }
  return std::nullopt;
}

}  // namespace ipos::library
