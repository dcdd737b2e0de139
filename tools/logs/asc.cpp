// Vector's text form: "date ...", "base hex  timestamps absolute", then " 0.000100 1  605  Rx  d 8 40 00 ..". Hardware of CAN
// FD logs classic frames in the same lines as those of CAN FD: " 0.000100 CANFD 1 Rx 605 0 0 8 8 40 00 .. FLAGS ..". What
// follows the data is passed over (SavvyCAN#422). Times count from the date; one that is not understood counts as virtual
// time 0, and is told. No time zone is written in it: UTC is taken (ours).
#include <fmt/format.h>

#include "tools/logs/asc_date.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

// "internal events logged", "no internal events logged", "Begin Triggerblock ...", comments.
bool is_frame_of_the_log(std::string_view first) {
  return first == "internal" || first == "no" || first == "Begin" || first == "End" ||
         first.starts_with("//");
}

constexpr uint32_t kFdFormat = 0x1000, kRemote = 0x10;  // in the flags of a CANFD line

class AscReader {
 public:
  explicit AscReader(const LogReader& reader) : reader_(reader) {}

  void take(std::string_view row, size_t line) {
    Fields fields(row);
    const std::string_view first = fields.next();
    if (first == "date") {
      if (const auto date = asc_date(fields))
        date_ = *date;
      else
        reader_.note({line, 6}, "a date that is not understood: times count from 1 January 2000");
    } else if (first == "base") {
      base_ = fields.next() == "dec" ? 10 : 16;
      fields.next();
      relative_ = fields.next() == "relative";
    } else if (first[0] >= '0' && first[0] <= '9') {
      if (const auto done = event(Fields(row), line); !done)
        reader_.wrong({line, done.error().column}, done.error().message);
    } else if (!is_frame_of_the_log(first)) {
      reader_.left_out(LeftOut::Record);
    }
  }

 private:
  tl::expected<void, FieldError> event(Fields fields, size_t line) {
    const auto time = decimal_time(fields.next(), 9);
    if (!time) return fields.wrong("time in seconds expected");
    if (relative_ && *time > kLongestLog - last_) return fields.wrong("a time later than this project knows");
    last_ = relative_ ? last_ + *time : *time;
    const std::string_view kind = fields.next();
    if (kind == "CANFD") return fd_line(fields, line);
    const auto channel = whole<unsigned>(kind);
    if (!channel) return kind == "Start" ? tl::expected<void, FieldError>{} : leave_out(LeftOut::Record);
    const std::string_view name = fields.next();
    runtime::Frame frame;
    const auto is_frame = identifier(fields, name, frame);
    if (!is_frame) return tl::unexpected(is_frame.error());
    if (!*is_frame) return leave_out(name == "ErrorFrame" ? LeftOut::ErrorFrame : LeftOut::Record);
    const std::string_view way = fields.next();
    if (way == "TxRq") return leave_out(LeftOut::TransmitRequest);
    if (way != "Rx" && way != "Tx") return fields.wrong("Rx or Tx expected");
    const std::string_view data = fields.next();
    frame.remote = data == "r" || data == "R";
    if (!frame.remote && data != "d" && data != "D") return fields.wrong("d or r expected");
    const std::string_view size = fields.next();
    const auto dlc = dlc_of(size);
    if (!dlc && !(frame.remote && (size.empty() || size == "Length"))) return fields.wrong("length expected");
    if (dlc.value_or(0) > kLargestDlc) return fields.wrong("a DLC above 15");
    frame.length = classic_length(dlc.value_or(0));
    return give(fields, *channel, frame, line);
  }

  // After "CANFD": channel, direction, identifier, name of the frame or nothing, bit rate switch, error state, DLC, number of
  // bytes, bytes, duration, length, flags.
  tl::expected<void, FieldError> fd_line(Fields fields, size_t line) {
    const auto channel = whole<unsigned>(fields.next());
    if (!channel) return leave_out(LeftOut::Record);
    const std::string_view way = fields.next();
    const std::string_view name = fields.next();
    if (name == "ErrorFrame") return leave_out(LeftOut::ErrorFrame);
    if (way == "TxRq") return leave_out(LeftOut::TransmitRequest);
    if (way != "Rx" && way != "Tx") return fields.wrong("Rx or Tx expected");
    runtime::Frame frame;
    const auto is_frame = identifier(fields, name, frame);
    if (!is_frame) return tl::unexpected(is_frame.error());
    if (!*is_frame) return leave_out(LeftOut::Record);
    if (const std::string_view next = fields.peek(); next != "0" && next != "1") fields.next();
    fields.next();
    fields.next();
    const auto dlc = dlc_of(fields.next());
    if (!dlc || *dlc > kLargestDlc) return fields.wrong("DLC expected");
    const auto bytes = whole<uint8_t>(fields.next());
    if (!bytes || *bytes > 64) return fields.wrong("number of data bytes expected");
    Fields behind = fields;
    for (unsigned n = 0; n < *bytes + 2U; ++n) behind.next();
    const auto flags = whole<uint32_t>(behind.next(), 16);
    if (!flags) return behind.wrong("flags of the frame expected");
    if ((*flags & kFdFormat) != 0) return leave_out(LeftOut::FdFrame);
    frame.remote = (*flags & kRemote) != 0 || (*bytes == 0 && *dlc != 0);
    frame.length = classic_length(*dlc);
    if (!frame.remote && *bytes != frame.length)
      return fields.wrong("as many bytes as the DLC says expected");
    return give(fields, *channel, frame, line);
  }

  // Always of one digit but where all numbers are decimal.
  std::optional<uint8_t> dlc_of(std::string_view text) const {
    return whole<uint8_t>(text, text.size() == 1 ? 16 : base_);
  }

  // False: there is another word in its place.
  tl::expected<bool, FieldError> identifier(const Fields& fields, std::string_view text,
                                            runtime::Frame& frame) const {
    frame.extended = text.ends_with('x') || text.ends_with('X');
    if (frame.extended) text.remove_suffix(1);
    if (text.empty()) return fields.wrong("identifier expected");
    if (text.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos) return false;
    const auto number = whole<uint32_t>(text, base_);
    frame.id = number.value_or(UINT32_MAX);
    if (!number || !is_valid(frame)) return fields.wrong("identifier too large");
    return true;
  }

  tl::expected<void, FieldError> leave_out(LeftOut what) {
    reader_.left_out(what);
    return {};
  }

  tl::expected<void, FieldError> give(Fields& fields, unsigned channel, runtime::Frame& frame, size_t line) {
    if (!frame.remote)
      if (auto error = read_bytes(fields, base_, frame)) return tl::unexpected(std::move(*error));
    reader_.can({date_ + last_, fmt::format("can{}", channel), frame}, {line, 1});
    return {};
  }

  const LogReader& reader_;
  Time date_ = 0;
  Time last_ = 0;
  int base_ = 16;
  bool relative_ = false;
};

}  // namespace

void read_asc(std::string_view text, const LogReader& reader) {
  AscReader asc(reader);
  for_each_line(text, [&](std::string_view row, size_t line) { asc.take(row, line); });
}

}  // namespace ipos::tools
