// CAN lines: a row an identifier.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "runtime/bus/can/identifier_text.hpp"
#include "tools/serve/bus_ear.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Frame;
using runtime::Time;

Frame frame_of(const Telegram& telegram) {
  Frame frame;
  frame.id = telegram.id;
  frame.length = static_cast<uint8_t>(telegram.data.size());
  frame.extended = telegram.extended;
  frame.remote = telegram.remote;
  std::copy(telegram.data.begin(), telegram.data.end(), frame.data.begin());
  return frame;
}

class CanEar final : public BusEar, private runtime::CanObserver, private runtime::CanNode {
 public:
  CanEar(runtime::CanLine& line, Hear hear, Names names)
      : line_(line), hear_(std::move(hear)), names_(std::move(names)) {
    line.add_observer(static_cast<runtime::CanObserver&>(*this));
  }

  const std::string& name() const override { return line_.name(); }
  runtime::LineLoad load(Time now) const override { return line_.load(now); }
  std::string text_of(const Telegram& telegram) override {
    return runtime::describe(names_.now(), frame_of(telegram)).text;
  }
  std::string identity_text(const Telegram& telegram) const override {
    return fmt::format("{} {}", telegram.id, runtime::id_text(telegram.id, telegram.extended));
  }

  std::vector<uint8_t> read(const std::string& text) const override {
    return bytes_of(text, std::tuple_size_v<decltype(Frame::data)>);
  }

  void send(const Arguments& a) override {
    Telegram telegram;
    telegram.data = read(a.text("data", ""));
    telegram.extended = a.flag("extended", false);
    telegram.remote = a.flag("remote", false);
    telegram.id = static_cast<uint32_t>(a.whole(
        "identifier", 0, (telegram.extended ? runtime::kExtendedIdLimit : runtime::kStandardIdLimit) - 1));
    if (!node_) node_ = line_.attach(kPageNode, line_.baud(), *this);
    switch (line_.send(*node_, frame_of(telegram), ++sent_)) {
      case runtime::SendStatus::Queued: return;
      case runtime::SendStatus::QueueFull: throw Mistake("too many telegrams wait for the line");
      case runtime::SendStatus::NotActive:
        throw Mistake("the line does not let the page take part: bus-off, or its wires are disturbed");
      case runtime::SendStatus::InvalidFrame: throw Mistake("this is no telegram");
    }
  }

 private:
  void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override {
    Telegram telegram;
    telegram.time = record.end;
    telegram.id = record.frame.id;
    telegram.extended = record.frame.extended;
    telegram.remote = record.frame.remote;
    telegram.data.assign(record.frame.data.begin(), record.frame.data.begin() + record.frame.length);
    hear_(std::move(telegram));
  }
  void on_line_event(const runtime::CanLine& line, const runtime::LineEvent& event) override {
    ++errors;
    state = describe(line, event);
  }
  // The page's node only sends.
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, runtime::NotSent) override {}

  runtime::CanLine& line_;
  Hear hear_;
  KeptNames names_;
  std::optional<runtime::NodeId> node_;
  uint64_t sent_ = 0;
};

}  // namespace

std::unique_ptr<BusEar> listen(runtime::CanLine& line, BusEar::Hear hear, BusEar::Names names) {
  return std::make_unique<CanEar>(line, std::move(hear), std::move(names));
}

}  // namespace ipos::tools::serve
