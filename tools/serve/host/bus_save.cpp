// The trace as a file of another tool, in parts: a message has no room for all of it.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "tools/serve/host/bus_traffic.hpp"
#include "tools/serve/host/trace_choice.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kSavedAtOnce = 20'000;  // telegrams of a part (ours)

struct FormRow {
  std::string_view name;
  std::string_view ending;  // of tools/logs/writing
  std::string_view file;    // of the download
  bool can_only;
};
constexpr FormRow kForms[] = {{"candump", "", ".log", true}, {"asc", ".asc", ".asc", true}, {"pcapng", ".pcapng", ".pcapng", false}};

constexpr std::string_view kind_text(LineKind kind) {
  return kind == LineKind::Can ? "CAN" : kind == LineKind::Serial ? "RS-485" : "PROFIBUS";
}

// Bytes in a text message (RFC 4648).
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t at = 0; at < bytes.size(); at += 3) {
    uint32_t group = 0;
    for (size_t n = 0; n < 3; ++n) group = group << 8 | (at + n < bytes.size() ? static_cast<uint8_t>(bytes[at + n]) : 0U);
    for (size_t n = 0; n < 4; ++n)
      text += at + n <= bytes.size() ? kDigits[group >> (18 - 6 * n) & 0x3F] : '=';
  }
  return text;
}

}  // namespace

Json BusTraffic::saved(const Arguments& a) const {
  const std::string wanted = a.text("form");
  const auto form = std::find_if(std::begin(kForms), std::end(kForms), [&](const FormRow& row) { return row.name == wanted; });
  if (form == std::end(kForms)) throw Mistake(fmt::format("'form' must be candump, asc or pcapng, not '{}'", wanted));
  const auto after = static_cast<uint64_t>(a.whole("after", 0, INT64_MAX, 0));
  const auto until = static_cast<uint64_t>(a.whole("until", 0, INT64_MAX, static_cast<int64_t>(std::min<uint64_t>(seen_, INT64_MAX))));
  const TraceChoice choice(monitors_, source_, a);

  LogPart part;
  Json left_out = Json::array();
  std::vector<uint64_t> next, end;
  for (size_t n = 0; n < monitors_.size(); ++n) {
    const LineMonitor& monitor = *monitors_[n];
    const bool chosen = !choice.line() || *choice.line() == n;
    const bool fits = !form->can_only || monitor.kind() == LineKind::Can;
    if (chosen && fits) part.lines.push_back({monitor.name(), monitor.kind()});
    if (chosen && !fits)
      left_out.push_back(fmt::format("{} is a {} line, and {} has a place for CAN frames only; pcapng carries it",
                                     monitor.name(), kind_text(monitor.kind()), form->name));
    next.push_back(find(n, after + 1));
    end.push_back(chosen && fits ? find(n, until + 1) : next.back());
  }
  if (part.lines.empty()) throw Mistake(left_out.empty() ? "there is no line" : left_out.front().get<std::string>());
  part.begins = after == 0;

  // The lines in the order of their telegrams, from the oldest one on.
  std::vector<NumberedTelegram> telegrams;
  uint64_t reached = after;
  for (size_t looks = 0; looks < kSavedAtOnce; ++looks) {
    std::optional<size_t> oldest;
    for (size_t n = 0; n < monitors_.size(); ++n)
      if (next[n] < end[n] && (!oldest || trace_.number(n, next[n]) < trace_.number(*oldest, next[*oldest]))) oldest = n;
    part.ends = !oldest;
    if (!oldest) break;
    NumberedTelegram one = trace_.at(*oldest, next[*oldest]++);
    reached = one.number;
    if (choice.takes(one)) telegrams.push_back(std::move(one));
  }
  std::ostringstream out;
  {
    const auto writer = make_writer(form->ending, out, part);
    for (const NumberedTelegram& one : telegrams) monitors_[one.telegram.bus]->write(*writer, one.telegram);
  }
  const std::string bytes = std::move(out).str();
  const bool text = form->can_only;
  return {{"file", fmt::format("trace{}", form->file)},
          {text ? "text" : "base64", text ? bytes : base64(bytes)},
          {"telegrams", telegrams.size()},
          {"until", until},
          {"next", part.ends ? Json(nullptr) : Json(reached)},
          {"left_out", std::move(left_out)}};
}

}  // namespace ipos::tools::serve
