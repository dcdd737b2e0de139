// PROFIBUS lines: a row for each kind of frame by source, destination and access points. Data are the octets of the whole
// frame, as `ipos bus decode --profibus` takes them.
#include <fmt/format.h>

#include <optional>

#include "runtime/bus/log/profibus_log.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/bus/words/bus_words.hpp"
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

class ProfibusMonitor final : public LineMonitor, private profibus::LineObserver, private profibus::Node {
 public:
  ProfibusMonitor(profibus::Line& line, Hear hear) : line_(line), hear_(std::move(hear)) {
    line.add_observer(static_cast<profibus::LineObserver&>(*this));
  }

  const std::string& name() const override { return line_.name(); }
  runtime::LineLoad load(Time now) const override { return line_.load(now); }

  // What overlapped or came too early has octets without a mistake: the line has said why it is void.
  std::string text_of(const Telegram& telegram) override {
    std::optional<FrameError> reason;
    if (telegram.error) reason = static_cast<FrameError>(telegram.reason);
    return words_.describe(runtime::reception_of(telegram.data, telegram.time, telegram.time, reason));
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
  void on_frame(const profibus::Line&, runtime::NodeId, const profibus::Reception& reception) override {
    Telegram telegram;
    telegram.time = reception.end;
    telegram.error = !reception.frame;
    telegram.reason = reception.frame ? uint8_t{0} : static_cast<uint8_t>(reception.frame.error());
    telegram.id = reception.frame ? identity_of(*reception.frame) : kVoid;
    telegram.data = reception.octets;
    if (telegram.error) ++errors;
    hear_(std::move(telegram));
  }
  // What it makes of frames is counted when they end; a frame that is lost is heard by nobody.
  void on_line_event(const profibus::Line& line, const profibus::LineEvent& event) override {
    if (event.fault == profibus::LineFaultKind::Lost) ++errors;
    state = describe(line, event);
  }
  // The page's node only sends.
  void on_reception(Time, const profibus::Reception&) override {}
  void on_sent(Time) override {}

  profibus::Line& line_;
  Hear hear_;
  runtime::BusWords words_;
  std::optional<runtime::NodeId> node_;
};

}  // namespace

std::unique_ptr<LineMonitor> listen(profibus::Line& line, const Clock&, LineMonitor::Hear hear) {
  return std::make_unique<ProfibusMonitor>(line, std::move(hear));
}

}  // namespace ipos::tools::serve
