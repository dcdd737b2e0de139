// PROFIBUS lines: a row for each kind of frame by source, destination and access points. Data are the octets of the whole
// frame, as `ipos bus decode --profibus` takes them.
#include <fmt/format.h>

#include <optional>

#include "runtime/bus/log/profibus_log.hpp"
#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/station/profibus_bus.hpp"
#include "runtime/station/profibus_octets.hpp"
#include "tools/serve/host/line_monitor.hpp"

namespace ipos::tools::serve {
namespace {

using profibus::Delimiter;
using profibus::FdlFrame;
using profibus::FdlRequest;
using profibus::FrameError;
using runtime::Time;

constexpr size_t kMostOctets = profibus::kLongestLength + 6;  // SD2: 68 LE LE 68 .. FCS 16
constexpr uint8_t kNoAccessPoint = 64;                        // they are 0 to 63

// Where FC stands: after DA and SA.
constexpr size_t control_place(Delimiter kind) { return kind == Delimiter::SD2 ? 6 : 3; }

// Questions about the station, which no service answers; and answers without data.
bool is_short(const FdlFrame& frame) {
  return frame.is_request() ? frame.asks(FdlRequest::FdlStatus) || frame.asks(FdlRequest::Ident) ||
                                  frame.asks(FdlRequest::LsapStatus)
                            : frame.kind == Delimiter::SD1;
}

// One number for frames that have the same row (ours; docs/reference/serve.md).
uint32_t identity_of(const FdlFrame& frame) {
  const uint32_t kind = frame.is_acknowledgement() ? 0 : frame.is_token() ? 1 : frame.is_request() ? 2 : 3;
  uint32_t id = kind << 1 | (is_short(frame) ? 1 : 0);
  for (const uint32_t part :
       {uint32_t{frame.source}, uint32_t{frame.destination}, uint32_t{frame.ssap.value_or(kNoAccessPoint)},
        uint32_t{frame.dsap.value_or(kNoAccessPoint)}})
    id = id << 7 | (part & 0x7F);
  return id;
}
constexpr uint32_t kVoid = UINT32_MAX;

bool is_configuration(const FdlFrame& frame) {
  return frame.has_control() && frame.dsap && profibus::dp_service(*frame.dsap) == profibus::DpService::ChkCfg;
}

// What overlapped or came too early has octets without a mistake: the line has said why it is void.
profibus::Reception dp_reception(const Telegram& telegram) {
  std::optional<FrameError> reason;
  if (telegram.error) reason = static_cast<FrameError>(telegram.reason);
  return runtime::reception_of(telegram.data, telegram.time - telegram.took, telegram.time, reason);
}

class ProfibusMonitor final : public LineMonitor, private profibus::LineObserver, private profibus::Node {
 public:
  ProfibusMonitor(profibus::Line& line, const Clock& clock, Hear hear, DpNamesNow names)
      : line_(line), hear_(std::move(hear)), look_up_(std::move(names)), words_(look_up_()), age_(clock) {
    line.add_observer(static_cast<profibus::LineObserver&>(*this));
  }

  const std::string& name() const override { return line_.name(); }
  runtime::LineLoad load(Time now) const override { return line_.load(now); }

  std::string text_of(const Telegram& telegram) override {
    return telegram.words.empty() ? text_if_heard(telegram) : telegram.words;
  }
  void renew_names(Time now) override {
    if (now < renewed_ + kNamesStay) return;
    renewed_ = now;
    words_.use(look_up_());
  }
  // How process data are divided, a frame of before has said.
  std::string words_of(const Telegram& telegram) override {
    const profibus::Reception reception = dp_reception(telegram);
    const bool told = reception.frame && (words_.is_known_exchange(*reception.frame) || is_configuration(*reception.frame));
    return told ? words_.describe(reception) : std::string();
  }
  // A copy hears it, so that a question leaves nothing behind.
  std::string text_if_heard(const Telegram& telegram) override {
    if (age_.is_over()) words_.use(look_up_());
    runtime::DpLineWords words = words_;
    return words.describe(dp_reception(telegram));
  }
  std::string identity_text(const Telegram&) const override { return {}; }  // the words have it
  Json identity(const Telegram& telegram) const override {
    const auto frame = profibus::decode(telegram.data);
    const bool has_addresses = frame && !telegram.error && !frame->is_acknowledgement();
    const auto point = [&](std::optional<uint8_t> FdlFrame::*sap) {
      return has_addresses && (*frame).*sap ? Json(*((*frame).*sap)) : Json(nullptr);
    };
    return {{"source", has_addresses ? Json(frame->source) : Json(nullptr)},
            {"destination", has_addresses ? Json(frame->destination) : Json(nullptr)},
            {"ssap", point(&FdlFrame::ssap)},
            {"dsap", point(&FdlFrame::dsap)}};
  }

  std::string sender_of(const Telegram& telegram) const override { return node_name(line_, telegram.sender); }
  std::vector<uint32_t> addresses(const Telegram& telegram) const override {
    const auto frame = profibus::decode(telegram.data);
    if (!frame || telegram.error || frame->is_acknowledgement()) return {};
    return {frame->source, frame->destination};
  }
  // A short acknowledgement does not say whose it is: it answers what came just before.
  bool answers(const Telegram& question, const Telegram& later) const override {
    const auto asked = profibus::decode(question.data), said = profibus::decode(later.data);
    if (!asked || !said || question.error || later.error || !asked->has_control() || !asked->is_request()) return false;
    if (said->is_acknowledgement()) return true;
    return said->has_control() && !said->is_request() && said->source == asked->destination &&
           said->destination == asked->source;
  }
  // At once or not at all: nobody else speaks before (PROFIBUS, slot time).
  size_t answered_within() const override { return 1; }
  LineKind kind() const override { return LineKind::Dp; }
  void write(LogWriter& log, const Telegram& telegram) const override { log.dp(name(), dp_reception(telegram)); }

  // The frame count bit turns round with every request, and the frame check follows from the rest.
  std::vector<uint8_t> compared(const Telegram& telegram) const override {
    std::vector<uint8_t> octets = telegram.data;
    const auto frame = profibus::decode(octets);
    if (!frame || !frame->has_control()) return octets;
    if (frame->is_request())
      octets[control_place(frame->kind)] &= static_cast<uint8_t>(~profibus::control::kFrameCount);
    octets[octets.size() - 2] = 0;
    return octets;
  }

  std::vector<uint8_t> read(const std::string& text) const override {
    if (text.find("fcs") == std::string::npos) return bytes_of(text, kMostOctets);
    const auto octets = runtime::parse_octets(text);
    if (!octets) throw Mistake(runtime::ProfibusBus::refuse(text).value_or("these are no octets"));
    if (octets->size() > kMostOctets)
      throw Mistake(fmt::format("a frame has at most {} octets", kMostOctets));
    return *octets;
  }

  // Without the token and any manners, but after the idle time that a request wants.
  void send(const Arguments& a) override {
    const std::vector<uint8_t> octets = read(a.text("data", ""));
    if (octets.empty()) throw Mistake("a frame needs octets");
    if (!node_) node_ = line_.attach(kPageNode, *this);
    if (!line_.send(*node_, line_.quiet_since() + profibus::kSynBits, octets))
      throw Mistake("the last one is still on its way");
  }

 private:
  void on_frame(const profibus::Line&, runtime::NodeId sender, const profibus::Reception& reception) override {
    Telegram telegram;
    telegram.time = reception.end;
    telegram.took = reception.end - reception.start;
    telegram.sender = sender_number(sender);
    telegram.error = !reception.frame;
    telegram.reason = reception.frame ? uint8_t{0} : static_cast<uint8_t>(reception.frame.error());
    telegram.id = reception.frame ? identity_of(*reception.frame) : kVoid;
    telegram.data = reception.octets;
    if (telegram.error) ++errors;
    hear_(std::move(telegram));
  }
  // What it makes of frames is counted when they end; a frame that is lost is heard by nobody.
  void on_line_event(const profibus::Line& line, const profibus::LineEvent& event) override {
    if (event.fault == runtime::OctetFaultKind::Lost) ++errors;
    state = describe(line, event);
  }
  // The page's node only sends.
  void on_reception(Time, const profibus::Reception&) override {}
  void on_sent(Time) override {}

  profibus::Line& line_;
  Hear hear_;
  DpNamesNow look_up_;
  runtime::DpLineWords words_;
  NamesAge age_;  // of the words of what was not heard
  Time renewed_ = 0;
  std::optional<runtime::NodeId> node_;
};

}  // namespace

std::unique_ptr<LineMonitor> listen(profibus::Line& line, const Clock& clock, LineMonitor::Hear hear, DpNamesNow names) {
  return std::make_unique<ProfibusMonitor>(line, clock, std::move(hear), std::move(names));
}

}  // namespace ipos::tools::serve
