// Logs of buses in the forms of other tools: which there are, how one is known by its content, how each is
// read. docs/guide/bus-tools.md has what of each form is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/profibus_log.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "tools/logs/left_out.hpp"

namespace ipos::tools {

enum class LogForm : uint8_t {
  Lines,   // candump, the serial log, bare telegrams: each line tells by itself
  Pcapng,  // Wireshark
  Pcap,    // tcpdump, and Wireshark on demand
  Asc,     // Vector, text
  Trc,     // PEAK
  Blf,     // Vector, binary
  Packed,  // one of these with gzip: see unpacked_log()
  Other,   // no log, or one of a form that is not read: see other_file()
};

// By the first bytes of a log, kToKnowTheForm of them or all.
inline constexpr size_t kToKnowTheForm = 512;
LogForm log_form(std::string_view begin);

// A mistake in a binary log has a byte instead of a line.
struct LogPlace {
  size_t line = 0;    // from 1; 0: binary
  size_t column = 0;  // from 1; of a binary log the byte, from 0
};

// "can.log:3:31", "can.blf: byte 144".
std::string place_text(const std::string& path, LogPlace place);

// Who reads a log.
struct LogReader {
  std::function<void(const runtime::LogEntry&, LogPlace)> can;
  std::function<void(const runtime::SerialEntry&, LogPlace)> serial;
  std::function<void(const runtime::ProfibusEntry&, LogPlace)> dp;
  std::function<void(LogPlace, const std::string& message)> wrong;
  std::function<void(LeftOut)> left_out = [](LeftOut) {};
  // What is read, but not as it was meant.
  std::function<void(LogPlace, const std::string& message)> note = [](LogPlace, const std::string&) {};
};

// All of a log in order, packed or not. Text goes on after a bad line; a binary log ends where it is damaged.
void read_log(std::string_view bytes, const LogReader& reader);

// A line of LogForm::Lines.
void read_log_line(std::string_view row, size_t line, const LogReader& reader);
// As candump prints it on a terminal. False: it is of another form.
bool read_terminal_line(std::string_view row, size_t line, const LogReader& reader);

// What a file is that is no log to be read, in words and with what to do; nothing for a log.
std::optional<std::string> other_file(std::string_view begin);

// What is in a log packed with gzip; the error is why nothing can be. Of a text whole lines only.
struct UnpackedLog {
  std::string bytes;
  bool whole = true;  // the packed file is not cut off
};
tl::expected<UnpackedLog, std::string> unpacked_log(std::string_view packed);

// The forms, each in a file of its own. Times are those of the log, since runtime::kCandumpEpoch.
void read_asc(std::string_view text, const LogReader& reader);
void read_trc(std::string_view text, const LogReader& reader);
void read_pcap(std::string_view bytes, const LogReader& reader);
void read_pcapng(std::string_view bytes, const LogReader& reader);
void read_blf(std::string_view bytes, const LogReader& reader);

// Calls `take` for each line that is not empty, with its number.
void for_each_line(std::string_view text, const std::function<void(std::string_view, size_t)>& take);

}  // namespace ipos::tools
