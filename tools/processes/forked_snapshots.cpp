// fork(), a line to each copy, and nothing else. A copy whose line nobody can write to any more ends, so none
// is left behind. Who goes back ends when the copy has said that it goes on, not before.
#include "tools/processes/forked_snapshots.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "tools/processes/whole_bytes.hpp"

namespace ipos::tools {
namespace {

// More cost memory and gain little: a step back replays what lies between two of them.
constexpr size_t kMost = 48;
// Of a large plant there are fewer, so that all of them together have no more than that for themselves (ours).
constexpr size_t kMostKib = 32 * 1024;
constexpr size_t kFewest = 8;
constexpr size_t kLookEvery = 8;  // at what they have
constexpr size_t kDensePart = 3;  // of so many the latest one is never thinned out

// What a copy answers to who wants to go on from it.
constexpr char kGoesOn = '1';
constexpr char kCannot = '0';

bool connected(std::array<int, 2>& ends) {
  return socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0;
}

// Size 0 tells it to end.
bool send(int file, const std::string& bytes) {
  const uint64_t size = bytes.size();
  return write_all(file, reinterpret_cast<const char*>(&size), sizeof size) &&
         write_all(file, bytes.data(), bytes.size());
}

std::string receive(int file) {
  uint64_t size = 0;
  if (!read_all(file, reinterpret_cast<char*>(&size), sizeof size)) return {};
  std::string bytes(size, '\0');
  if (!read_all(file, bytes.data(), bytes.size())) return {};
  return bytes;
}

}  // namespace

ForkedSnapshots::ForkedSnapshots() : most_(kMost) {}
ForkedSnapshots::~ForkedSnapshots() { drop_all(); }

void ForkedSnapshots::drop_all() {
  while (!held_.empty()) drop(held_.size() - 1);
}

void ForkedSnapshots::drop(size_t n) {
  send(held_[n].line, {});
  close(held_[n].line);
  held_.erase(held_.begin() + static_cast<ptrdiff_t>(n));
}

// Every second one of the older ones goes: the way back to them gets longer the older they are.
void ForkedSnapshots::thin_out() {
  for (size_t n = 1; n + most_ / kDensePart < held_.size(); ++n) drop(n);
}

std::optional<std::string> ForkedSnapshots::take(const Position& now) {
  std::array<int, 2> ends{};
  if (!connected(ends)) return std::nullopt;
  std::fflush(nullptr);
  const pid_t copy = fork();
  if (copy != 0) {
    close(ends[0]);
    if (copy < 0) {
      close(ends[1]);  // no memory for another one: the way back is longer, that is all
      return std::nullopt;
    }
    held_.push_back({now, ends[1], copy});
    if (++taken_ % kLookEvery == 0)
      most_ = std::clamp(held_.size() * kMostKib / std::max<size_t>(memory().own, 1), kFewest, kMost);
    if (held_.size() > most_) thin_out();
    return std::nullopt;
  }
  const auto on_interrupt = std::signal(SIGINT, SIG_IGN);
  close(ends[1]);
  for (int line = ends[0];;) {
    const std::string bytes = receive(line);
    if (bytes.empty()) _exit(0);
    // A new line, as the other end belongs to who goes on from here.
    std::array<int, 2> next{};
    const pid_t going_on = connected(next) ? fork() : -1;
    if (going_on < 0) {  // no room for another one: the caller takes the longer way
      for (const int end : next)
        if (end > 0) close(end);
      write_all(line, &kCannot, 1);
      continue;
    }
    if (going_on > 0) {
      close(line);
      close(next[1]);
      line = next[0];
      continue;
    }
    close(next[0]);
    write_all(line, &kGoesOn, 1);
    close(line);
    held_.push_back({now, next[1], getppid()});
    std::signal(SIGINT, on_interrupt);
    return bytes;
  }
}

const debug::Position* ForkedSnapshots::before(const Position& position, bool strictly) const {
  const Position* found = nullptr;
  for (const Held& held : held_)
    if (strictly ? held.position < position : held.position <= position) found = &held.position;
  return found;
}

const debug::Position* ForkedSnapshots::before(runtime::Time time) const {
  const Position* found = nullptr;
  for (const Held& held : held_)
    if (held.position.time <= time) found = &held.position;
  return found;
}

void ForkedSnapshots::go_on_from(const Position& snapshot, const std::string& bytes) {
  std::fflush(nullptr);
  for (size_t n = held_.size(); n-- > 0;) {
    if (held_[n].position > snapshot)
      drop(n);
    else if (char reply = kCannot;
             send(held_[n].line, bytes) && read_all(held_[n].line, &reply, 1) && reply == kGoesOn)
      _exit(0);
    else
      drop(n);
  }
}

debug::Snapshots::Memory ForkedSnapshots::memory() const {
  Memory sum;
  for (const Held& held : held_) {
    std::ifstream file(fmt::format("/proc/{}/smaps_rollup", held.process));
    std::string line;
    while (std::getline(file, line)) {
      size_t kib = 0;
      if (std::sscanf(line.c_str(), "Pss: %zu", &kib) == 1) sum.shared_out += kib;
      if (std::sscanf(line.c_str(), "Private_Dirty: %zu", &kib) == 1) sum.own += kib;
    }
  }
  return sum;
}

}  // namespace ipos::tools
