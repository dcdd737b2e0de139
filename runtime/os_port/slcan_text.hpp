// The text form of CAN frames of the LAWICEL protocol ("slcan"), and the lines it comes in: commands and
// answers end with CR, BEL is the answer to a refused command.
//
//   tIIIL..  data frame, 11 bits      rIIIL  remote frame, 11 bits
//   TIIIIIIIIL..  the same, 29 bits   RIIIIIIIIL
// followed, where stamps are on, by four digits: milliseconds 0000..EA5F of the adapter's minute.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/bus/can/frame.hpp"

namespace ipos::runtime {

inline constexpr char kSlcanOk = '\r';
inline constexpr char kSlcanError = '\a';
inline constexpr uint32_t kSlcanStampPeriod = 60'000;  // ms
inline constexpr size_t kLongestSlcanLine = 31;

// Rates of S0..S8.
inline constexpr std::array<uint32_t, 9> kSlcanRates = {10'000,  20'000,  50'000,  100'000,  125'000,
                                                        250'000, 500'000, 800'000, 1'000'000};
// "S6" for 500000; nothing for a rate without a command.
std::optional<char> slcan_rate_digit(uint32_t baud);

// With its CR.
std::string slcan_text(const Frame& frame, std::optional<uint16_t> stamp = std::nullopt);

// How many lines stand in a text, a begun one counts.
size_t slcan_lines(std::string_view text);

struct SlcanFrame {
  Frame frame;
  std::optional<uint16_t> stamp;  // ms
};

// A line without its CR; nothing when it is not exactly a frame.
std::optional<SlcanFrame> parse_slcan(std::string_view line);

// The same as adapters of others send it: CANDapter has x in place of T (python-can#1528), and newer firmware of CANable has
// stamps of eight digits. Their unit is not in the protocol, so such a frame has none.
std::optional<SlcanFrame> parse_adapter_slcan(std::string_view line);

constexpr bool is_slcan_frame_letter(char c) { return c == 't' || c == 'T' || c == 'r' || c == 'R'; }

// Puts characters together to lines. Line feeds are skipped (ours: terminals send them).
class SlcanLines {
 public:
  enum class Kind : uint8_t {
    Line,     // ended with CR; may be empty
    Error,    // BEL; what stood before it is dropped
    TooLong,  // longer than any line of the protocol
  };

  // One character; the kind when something is complete.
  std::optional<Kind> push(char c);
  std::string_view line() const { return complete_; }  // of the last Kind::Line
  void clear();

 private:
  static constexpr size_t kLimit = kLongestSlcanLine + 9;

  std::string pending_;
  std::string complete_;
  bool too_long_ = false;
};

}  // namespace ipos::runtime
