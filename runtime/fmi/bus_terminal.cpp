// Frames of the line and operations.
#include "runtime/fmi/bus_terminal.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/fmi/can_operations.hpp"

namespace ipos::fmi {
namespace {

constexpr size_t kMostWaiting = 1 << 20;  // bytes that nobody fetches (ours)

}  // namespace

void BusTerminal::begin(library::Session& session) {
  buffers = {};
  fetched = false;
  library::Action join;
  join.act = library::Act::Join;
  join.number = line_;
  session.perform(std::move(join));
  buffers.out = configuration_operations(baud_);
}

bool BusTerminal::collect(library::Session& session) {
  auto& heard = session.instance().can()[line_]->heard();
  while (const auto frame = heard.take()) {
    if (frame->own || frame->error) continue;
    const std::string operation = transmit_operation(frame->frame);
    buffers.sent[frame->frame.id] = operation;
    if (buffers.out.size() < kMostWaiting) buffers.out += operation;
  }
  return !buffers.out.empty();
}

void BusTerminal::forget_heard(library::Session& session) const {
  auto& heard = session.instance().can()[line_]->heard();
  while (heard.take()) continue;
}

std::vector<std::string> BusTerminal::take_in(library::Session& session) {
  std::vector<std::string> wrong;
  const std::string bytes = std::exchange(buffers.in, {});
  for (const ReadOperation& operation : read_operations(bytes)) {
    if (!operation.is_good) {
      buffers.out += format_error_operation(operation.bytes);
      wrong.push_back(fmt::format("{}: an operation of {} bytes cannot be read", name_, operation.bytes.size()));
      continue;
    }
    const bool lost = operation.kind == CanOperation::ArbitrationLost ||
                      (operation.kind == CanOperation::BusError && operation.is_sender);
    if (lost && buffers.sent.contains(operation.id)) buffers.out += buffers.sent[operation.id];
    if (operation.kind != CanOperation::Transmit) continue;
    library::Action send;
    send.act = library::Act::Send;
    send.number = line_;
    send.value = session.next_tag();
    send.bytes = library::frame_bytes(runtime::canonical(operation.frame));
    if (session.instance().can()[line_]->is_full()) {
      wrong.push_back(fmt::format("{}: too many frames wait to be sent on the line; {:X}h is lost", name_, operation.id));
    } else if (const auto refused = session.perform(std::move(send))) {
      wrong.push_back(fmt::format("{}: {}", name_, *refused));
    }
  }
  return wrong;
}

std::vector<BusTerminal> terminals_of(const runtime::PlantFile& file) {
  std::vector<BusTerminal> terminals;
  uint32_t line = 0;
  for (const runtime::BusConfig& bus : file.buses) {
    if (bus.kind != runtime::BusKind::Can) continue;
    if (bus.port == runtime::kFmiPort) terminals.emplace_back(bus.name, line, bus.baud);
    ++line;
  }
  return terminals;
}

}  // namespace ipos::fmi
