// RS-485 lines: a row an address.
#include <fmt/format.h>

#include <optional>

#include "runtime/bus/words/bus_words.hpp"
#include "tools/serve/host/line_monitor.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Time;

constexpr size_t kMostBytes = std::tuple_size_v<decltype(runtime::SerialBytes::data)>;

runtime::Reception serial_reception(const Telegram& telegram) {
  runtime::Reception reception;
  for (const uint8_t byte : telegram.data) reception.bytes.push(byte);
  reception.telegram = runtime::decode_serial(telegram.data);
  if (telegram.error) reception.telegram = tl::unexpected(static_cast<runtime::SerialError>(telegram.reason));
  reception.start = telegram.time - telegram.took;
  reception.end = telegram.time;
  return reception;
}

class SerialMonitor final : public LineMonitor, private runtime::SerialObserver, private runtime::SerialNode {
 public:
  SerialMonitor(runtime::Rs485Line& line, const Clock& clock, Hear hear, SerialNamesNow names)
      : line_(line), hear_(std::move(hear)), look_up_(std::move(names)), age_(clock) {
    line.add_observer(static_cast<runtime::SerialObserver&>(*this));
  }

  const std::string& name() const override { return line_.name(); }
  runtime::LineLoad load(Time now) const override { return line_.load(now); }
  std::string text_of(const Telegram& telegram) override {
    if (age_.is_over()) words_.use({{}, look_up_(), {}});
    return words_.describe(serial_reception(telegram));
  }
  std::string identity_text(const Telegram& telegram) const override {
    return fmt::format("{} {:X}", telegram.id, telegram.id);
  }

  std::string sender_of(const Telegram& telegram) const override { return node_name(line_, telegram.sender); }
  std::vector<uint32_t> addresses(const Telegram& telegram) const override { return {telegram.id}; }
  bool answers(const Telegram& question, const Telegram& later) const override {
    const auto asked = runtime::decode_serial(question.data), said = runtime::decode_serial(later.data);
    return asked && said && !question.error && !later.error && !asked->response && said->response &&
           (asked->address == said->address || asked->address == runtime::kUniversalAddress);
  }
  LineKind kind() const override { return LineKind::Serial; }
  void write(LogWriter& log, const Telegram& telegram) const override { log.serial(name(), serial_reception(telegram)); }

  std::vector<uint8_t> read(const std::string& text) const override { return bytes_of(text, kMostBytes); }

  void send(const Arguments& a) override {
    const std::vector<uint8_t> bytes = read(a.text("data", ""));
    if (bytes.empty()) throw Mistake("a telegram needs bytes");
    if (!node_) node_ = line_.attach(kPageNode, line_.baud(), *this);
    if (!line_.send(*node_, bytes)) throw Mistake("the last one is still on its way");
  }

 private:
  void on_character(const runtime::Rs485Line&, runtime::NodeId sender,
                    const runtime::Character& character) override {
    const auto reception = receiver_.take(character);
    if (!reception) return;
    const auto& [bytes, size] = std::pair(reception->bytes.data, reception->bytes.size);
    Telegram telegram;
    telegram.time = reception->end;
    telegram.took = reception->end - reception->start;
    telegram.sender = sender_number(sender);
    telegram.error = !reception->telegram;
    telegram.reason = reception->telegram ? uint8_t{0} : static_cast<uint8_t>(reception->telegram.error());
    telegram.data.assign(bytes.begin(), bytes.begin() + size);
    telegram.id = size > 1 ? bytes[1] : 0;
    if (telegram.error) ++errors;
    hear_(std::move(telegram));
  }
  void on_serial_event(const runtime::Rs485Line&, const runtime::SerialEvent&) override { ++errors; }
  // The page's node only sends.
  void on_character(Time, const runtime::Character&) override {}
  void on_sent(Time) override {}

  runtime::Rs485Line& line_;
  Hear hear_;
  SerialNamesNow look_up_;
  runtime::BusWords words_;
  NamesAge age_;
  runtime::SerialReceiver receiver_;
  std::optional<runtime::NodeId> node_;
};

}  // namespace

std::unique_ptr<LineMonitor> listen(runtime::Rs485Line& line, const Clock& clock, LineMonitor::Hear hear, SerialNamesNow names) {
  return std::make_unique<SerialMonitor>(line, clock, std::move(hear), std::move(names));
}

}  // namespace ipos::tools::serve
