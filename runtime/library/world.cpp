// Deeds, one by one.
#include "runtime/library/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace ipos::library {
namespace {

const std::string_view kStrange = "this plant has nothing of the kind";

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

World::World(std::unique_ptr<runtime::Plant> plant) : plant_(std::move(plant)), actions_(*plant_, "the library") {
  for (const auto& bus : plant_->buses())
    runtime::visit(
        *bus, [this](runtime::CanBus& can) { can_.push_back(std::make_unique<CanTap>(can.line())); },
        [this](runtime::SerialBus& serial) { serial_.push_back(std::make_unique<SerialTap>(serial.line())); },
        [this](runtime::ProfibusBus& dp) { profibus_.push_back(std::make_unique<ProfibusTap>(dp.line())); });
}

Refusal World::touch(const Deed& deed) {
  const auto signal = signal_of(*plant_, deed.signal);
  if (!signal || signal->put == nullptr) return std::string(kStrange);
  if (auto refused = signal->check(deed.value)) return refused;
  if (deed.act == Act::Write) return actions_.set(*signal, deed.value);
  if (deed.act == Act::Force) return actions_.force(*signal, deed.value);
  actions_.release(*signal);
  return std::nullopt;
}

Refusal World::send(const Deed& deed) {
  if (deed.act == Act::SerialSend) {
    Refusal refused = std::string(kStrange);
    with_line(deed.number, [&](auto& tap) {
      if constexpr (requires { tap.send(std::span(deed.bytes)); })
        if (!deed.bytes.empty() && deed.bytes.size() <= tap.kLongest) refused = tap.send(deed.bytes);
    });
    return refused;
  }
  if (deed.number >= can_.size()) return std::string(kStrange);
  if (deed.act == Act::Join) {
    can_[deed.number]->join();
    return std::nullopt;
  }
  const auto frame = frame_of(deed.bytes);
  if (!frame) return std::string(kStrange);
  return can_[deed.number]->send(*frame, static_cast<uint32_t>(deed.value));
}

Refusal World::plant_faults(const Deed& deed) {
  const std::string text(deed.bytes.begin(), deed.bytes.end());
  runtime::PlantFileResult read = runtime::read_fault_tables(text, plant_->file());
  if (!read.errors.empty())
    return fmt::format("line {}, column {}: {}", read.errors.front().place.line,
                       read.errors.front().place.column, read.errors.front().text);
  for (runtime::FaultConfig& fault : read.plant.faults)
    if (auto refused = actions_.plant_fault(fault, plant_->now())) return refused;
  return std::nullopt;
}

Refusal World::perform(const Deed& deed) {
  switch (deed.act) {
    case Act::Write:
    case Act::Force:
    case Act::Release: return touch(deed);
    case Act::Join:
    case Act::Send:
    case Act::SerialSend: return send(deed);
    case Act::LineFault: return plant_faults(deed);
    default: break;
  }
  if (const runtime::Gateway* gateway = gateway_of(*plant_, deed.signal.station)) {
    if (deed.act != Act::PowerOff && deed.act != Act::PowerOn)
      return fmt::format("'{}' is a gateway: it has no program and no drive", gateway->config().name);
    plant_->set_power(gateway->config().name, deed.act == Act::PowerOn);
    return std::nullopt;
  }
  if (deed.signal.station >= plant_->stations().size()) return std::string(kStrange);
  Station& station = *plant_->stations()[deed.signal.station];
  switch (deed.act) {
    case Act::PowerOff:
    case Act::PowerOn: plant_->set_power(station.config().name, deed.act == Act::PowerOn); break;
    case Act::DriveFault:
      if (deed.value < 1 || deed.value > UINT8_MAX) return "a drive fault is 1..255";
      station.drive().state().raise_fault(static_cast<uint8_t>(deed.value));
      break;
    case Act::ResetFault: station.drive().state().reset_fault(); break;
    case Act::Program:
      if (deed.value < 0 || deed.value > static_cast<int64_t>(runtime::ProgramOrder::Restart))
        return std::string(kStrange);
      return runtime::PlantActions::order(station, static_cast<runtime::ProgramOrder>(deed.value));
    default: break;
  }
  return std::nullopt;
}

}  // namespace ipos::library
