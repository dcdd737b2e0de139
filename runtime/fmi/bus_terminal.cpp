// Frames of the line and operations, of a plant with stations.
#include "runtime/fmi/bus_terminal.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/fmi/can_operations.hpp"
#include "runtime/fmi/line_terminal.hpp"

namespace ipos::fmi {
namespace {

constexpr size_t kMostWaiting = 1 << 20;  // bytes that nobody fetches (ours)

class NodeTerminal final : public BusTerminal {
 public:
  // `line` counts the CAN lines of the plant.
  NodeTerminal(std::string name, uint32_t line, uint32_t baud) : BusTerminal(std::move(name)), line_(line), baud_(baud) {}

  bool is_of_the_line() const override { return false; }

  void begin(library::Session& session) override {
    buffers = {};
    fetched = false;
    library::Action join;
    join.act = library::Act::Join;
    join.number = line_;
    session.perform(std::move(join));
    buffers.out = configuration_operations(baud_);
  }

  bool collect(library::Session& session) override {
    auto& heard = session.instance().can()[line_]->heard();
    while (const auto frame = heard.take()) {
      if (frame->own || frame->error) continue;
      const std::string operation = transmit_operation(frame->frame);
      buffers.sent[frame->frame.id] = operation;
      put_out(operation);
    }
    return !buffers.out.empty();
  }

  runtime::Time next_time(library::Session&) const override { return runtime::kNever; }

  void forget_heard(library::Session& session) const override {
    auto& heard = session.instance().can()[line_]->heard();
    while (heard.take()) continue;
  }

 private:
  void act(const ReadOperation& operation, library::Session& session, Taken& taken) override {
    const bool lost = operation.kind == CanOperation::ArbitrationLost ||
                      (operation.kind == CanOperation::BusError && operation.is_sender);
    if (lost && buffers.notified && buffers.sent.contains(operation.id)) put_out(buffers.sent[operation.id]);
    if (operation.kind != CanOperation::Transmit) return;
    library::Action send;
    send.act = library::Act::Send;
    send.number = line_;
    send.value = session.next_tag();
    send.bytes = library::frame_bytes(runtime::canonical(operation.frame));
    if (session.instance().can()[line_]->is_full())
      taken.wrong.push_back(fmt::format("too many frames wait to be sent; {:X}h is lost", operation.id));
    else if (const auto refused = session.perform(std::move(send)))
      taken.wrong.push_back(*refused);
  }

  uint32_t line_;
  uint32_t baud_;
};

}  // namespace

void BusTerminal::put_out(const std::string& operation) {
  if (buffers.out.size() < kMostWaiting) buffers.out += operation;
}

BusTerminal::Taken BusTerminal::take_in(library::Session& session) {
  Taken taken;
  const std::string bytes = std::exchange(buffers.in, {});
  for (const ReadOperation& operation : read_operations(bytes)) {
    if (operation.is_good) {
      act(operation, session, taken);
    } else {
      put_out(format_error_operation(operation.bytes));
      taken.wrong.push_back(fmt::format("an operation of {} bytes cannot be read", operation.bytes.size()));
    }
  }
  return taken;
}

Terminals terminals_of(const runtime::PlantFile& file, const Choice& choice) {
  if (choice.line) return terminals_of_line(*choice.line);
  Terminals terminals;
  uint32_t line = 0;
  for (const runtime::BusConfig& bus : file.buses) {
    if (bus.kind != runtime::BusKind::Can) continue;
    if (bus.port == runtime::kFmiPort) terminals.push_back(std::make_unique<NodeTerminal>(bus.name, line, bus.baud));
    ++line;
  }
  return terminals;
}

}  // namespace ipos::fmi
