// CAN lines: a row an identifier. Words of CANopen frames are those of `ipos bus decode` and are made as the frames come,
// as a mapping and a segment are known from what went before.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "tools/serve/host/line_monitor.hpp"

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

// The identifier of the answer to a telegram of MOVILINK; nothing: there is none. A group does not answer.
std::optional<uint32_t> answer_of_unit(uint32_t id) {
  const auto question = runtime::classify_identifier(id);
  if (!question) return std::nullopt;
  using enum runtime::Telegram;
  std::optional<runtime::Telegram> answer;
  if (question->telegram == ProcessOutput || question->telegram == ProcessOutputSync) answer = ProcessInput;
  if (question->telegram == ParameterRequest) answer = ParameterResponse;
  if (question->telegram == ParameterRequest2) answer = ParameterResponse2;
  return answer ? std::optional(runtime::sbus_identifier(*answer, question->address)) : std::nullopt;
}
// The same of CANopen: a client of the SDO server asks.
std::optional<uint32_t> answer_of_node(uint32_t id) {
  using runtime::canopen::Connection;
  const auto question = runtime::canopen::connection_of(id);
  if (!question || question->connection != Connection::SdoRequest) return std::nullopt;
  return runtime::canopen::identifier(Connection::SdoResponse, question->node);
}

class CanMonitor final : public LineMonitor, private runtime::CanObserver, private runtime::CanNode {
 public:
  CanMonitor(runtime::CanLine& line, const Clock& clock, Hear hear, CanNamesNow names)
      : line_(line), hear_(std::move(hear)), look_up_(std::move(names)), words_(look_up_.names()), age_(clock) {
    line.add_observer(static_cast<runtime::CanObserver&>(*this));
  }

  const std::string& name() const override { return line_.name(); }
  runtime::LineLoad load(Time now) const override { return line_.load(now); }
  std::string text_of(const Telegram& telegram) override {
    return telegram.words.empty() ? text_if_heard(telegram) : telegram.words;
  }
  void renew_names(Time now) override {
    const size_t objects = look_up_.objects();
    if (objects == objects_ && now < renewed_ + kNamesStay) return;
    objects_ = objects;
    renewed_ = now;
    words_.use(look_up_.names());
  }
  std::string words_of(const Telegram& telegram) override {
    const Frame frame = frame_of(telegram);
    return words_.is_canopen(frame) ? words_.describe(frame).text : std::string();
  }
  // A copy hears it, so that a question leaves nothing behind.
  std::string text_if_heard(const Telegram& telegram) override {
    if (age_.is_over()) words_.use(look_up_.names());
    const Frame frame = frame_of(telegram);
    if (!words_.is_canopen(frame)) return words_.describe(frame).text;
    runtime::CanLineWords words = words_;
    return words.describe(frame).text;
  }
  std::string identity_text(const Telegram& telegram) const override {
    return fmt::format("{} {}", telegram.id, runtime::id_text(telegram.id, telegram.extended));
  }

  std::string sender_of(const Telegram& telegram) const override { return node_name(line_, telegram.sender); }
  bool answers(const Telegram& question, const Telegram& later) const override {
    if (question.extended || later.extended) return false;
    if (question.remote) return !later.remote && later.id == question.id;
    const auto answer = words_.is_canopen(frame_of(question)) ? answer_of_node(question.id) : answer_of_unit(question.id);
    return answer && later.id == *answer;
  }
  LineKind kind() const override { return LineKind::Can; }
  void write(LogWriter& log, const Telegram& telegram) const override {
    log.can(telegram.time, name(), frame_of(telegram));
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
    telegram.took = record.end - record.start;
    telegram.sender = sender_number(record.sender);
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
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, runtime::NotSent) override {}

  runtime::CanLine& line_;
  Hear hear_;
  CanNamesNow look_up_;
  runtime::CanLineWords words_;
  NamesAge age_;       // of the words of what was not heard, and of all that is not CANopen
  size_t objects_ = 0;  // of which words_ knows
  Time renewed_ = 0;
  std::optional<runtime::NodeId> node_;
  uint64_t sent_ = 0;
};

}  // namespace

std::unique_ptr<LineMonitor> listen(runtime::CanLine& line, const Clock& clock, LineMonitor::Hear hear, CanNamesNow names) {
  return std::make_unique<CanMonitor>(line, clock, std::move(hear), std::move(names));
}

}  // namespace ipos::tools::serve
