// An independent bit-by-bit model of one disturbed frame on a CAN line: a sender and listeners, each with its
// own decoder that looks at text of '0' and '1'. Shares no code with runtime/bus.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::tests {

inline uint64_t number(const std::string& bits) {
  uint64_t value = 0;
  for (const char bit : bits) value = value * 2 + (bit == '1' ? 1 : 0);
  return value;
}

// What a listener makes of the bits it has seen so far.
struct Reading {
  bool error = false;        // at the last of them
  bool acknowledge = false;  // the next bit is the acknowledge slot and the CRC fits
  bool complete = false;
};

inline Reading read_bits(const std::string& seen) {
  std::string plain;
  size_t run = 0;
  size_t i = 0;
  size_t wanted = ~size_t{0};
  for (; i < seen.size(); ++i) {
    const bool stuff = run == 5;
    if (plain.size() == wanted && !stuff) break;
    if (stuff && seen[i] == seen[i - 1]) return {i + 1 == seen.size(), false, false};
    run = i > 0 && seen[i] == seen[i - 1] ? run + 1 : 1;
    if (stuff) continue;
    plain += seen[i];
    const bool extended = plain.size() > 13 && plain[13] == '1';
    const size_t length_at = extended ? 35 : 15;
    if (plain.size() != length_at + 4) continue;
    const bool remote = plain[extended ? 32 : 12] == '1';
    const uint64_t length = number(plain.substr(length_at, 4));
    wanted = length_at + 4 + (remote ? 0 : 8 * std::min<uint64_t>(length, 8)) + 15;
  }
  if (plain.size() != wanted) return {};
  const bool good = crc15(plain.substr(0, wanted - 15)) == plain.substr(wanted - 15);
  const size_t tail = seen.size() - i;  // bits behind the CRC: delimiter, slot, delimiter, end of frame
  Reading reading;
  reading.acknowledge = good && tail == 1 && seen[i] == '1';
  if (tail == 0) return reading;
  const char last = seen.back();
  if (tail != 2 && tail < 10) reading.error = last == '0';
  if (tail == 3 && !good) reading.error = true;
  reading.complete = tail >= 9 && !reading.error;
  return reading;
}

struct Disturbed {
  size_t end = 0;              // behind the error delimiter
  std::vector<bool> received;  // per listener
  bool sender_content = false;
};

// `who`: -1 all, 0 the sender, n the n-th listener. All stations are error active unless listed.
inline Disturbed disturb(const std::string& wire, size_t inverted, int who, const std::vector<bool>& active) {
  const size_t stations = active.size();
  std::vector<std::string> seen(stations);
  std::vector<size_t> flag_from(stations, ~size_t{0});
  std::vector<bool> acknowledge(stations, false);
  std::vector<bool> complete(stations, false);
  std::string bus;
  const size_t slot = wire.size() - 9;
  for (size_t i = 0; i < wire.size() + 40; ++i) {
    char level = '1';
    for (size_t s = 0; s < stations; ++s) {
      if (flag_from[s] != ~size_t{0}) {
        if (active[s] && i >= flag_from[s] && i < flag_from[s] + 6) level = '0';
      } else if (s == 0 ? i < wire.size() && wire[i] == '0' : acknowledge[s]) {
        level = '0';
      }
    }
    bus += level;
    for (size_t s = 0; s < stations; ++s) {
      const bool turned = i == inverted && (who == -1 || who == static_cast<int>(s));
      const char mine = turned ? (level == '0' ? '1' : '0') : level;
      seen[s] += mine;
      acknowledge[s] = false;
      if (flag_from[s] != ~size_t{0} || complete[s]) continue;
      if (s == 0) {
        if (i >= wire.size()) continue;
        const bool error = i == slot ? mine == '1' : mine != wire[i];
        if (error) flag_from[s] = i + 1;
        if (i + 1 == wire.size() && !error) complete[s] = true;
        continue;
      }
      const Reading reading = read_bits(seen[s]);
      acknowledge[s] = reading.acknowledge;
      complete[s] = reading.complete;
      if (reading.error) flag_from[s] = i + 1;
    }
  }
  Disturbed result;
  for (size_t s = 1; s < stations; ++s) result.received.push_back(complete[s]);
  result.sender_content = complete[0];
  result.end = bus.find_last_of('0') + 1 + 8;
  return result;
}

}  // namespace ipos::tests
