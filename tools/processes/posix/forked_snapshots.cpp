// fork(), a line to each copy, and nothing else. A copy whose line nobody can write to any more ends, so none
// is left behind. Who goes back ends when the copy has said that it goes on, not before.
#include "tools/processes/posix/forked_snapshots.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

#include "tools/cli/whole_bytes.hpp"

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

struct Head {
  uint64_t bytes;  // 0: end
  uint64_t others;
};

constexpr size_t kMostOthers = 2 * kMost;
using Lines = std::array<char, CMSG_SPACE(kMostOthers * sizeof(int))>;

}  // namespace

ForkedSnapshots::ForkedSnapshots() : most_(kMost) {}
ForkedSnapshots::~ForkedSnapshots() { drop_all(); }

void ForkedSnapshots::drop_all() {
  while (!held_.empty()) drop(held_.size() - 1);
}

void ForkedSnapshots::drop(size_t n) {
  send(held_[n].line, {}, {});
  close(held_[n].line);
  held_.erase(held_.begin() + static_cast<ptrdiff_t>(n));
}

void ForkedSnapshots::drop_after(const Position& position) {
  while (!held_.empty() && held_.back().position > position) drop(held_.size() - 1);
}

void ForkedSnapshots::hold(const Held& held) {
  const auto later = [&](const Held& one) { return one.position > held.position; };
  held_.insert(std::find_if(held_.begin(), held_.end(), later), held);
}

// Of the older ones that one goes which leaves the shortest way, so they stand evenly and no way to a moment is long.
void ForkedSnapshots::thin_out() {
  while (held_.size() > most_) {
    size_t least = 1;
    const auto way = [this](size_t n) { return held_[n + 1].position.time - held_[n - 1].position.time; };
    for (size_t n = 2; n + most_ / kDensePart < held_.size(); ++n)
      if (way(n) < way(least)) least = n;
    drop(least);
  }
}

// The lines go beside the bytes: each gets a number of its own in the other process.
bool ForkedSnapshots::send(int line, const std::string& bytes, const std::vector<Held>& others) {
  Head head{bytes.size(), others.size()};
  iovec part{&head, sizeof head};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) Lines lines{};
  if (!others.empty()) {
    message.msg_control = lines.data();
    message.msg_controllen = CMSG_SPACE(others.size() * sizeof(int));
    cmsghdr* const beside = CMSG_FIRSTHDR(&message);
    beside->cmsg_level = SOL_SOCKET;
    beside->cmsg_type = SCM_RIGHTS;
    beside->cmsg_len = CMSG_LEN(others.size() * sizeof(int));
    for (size_t n = 0; n < others.size(); ++n)
      std::memcpy(CMSG_DATA(beside) + n * sizeof(int), &others[n].line, sizeof(int));
  }
  ssize_t sent = -1;
  do {
    sent = sendmsg(line, &message, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == sizeof head &&
         write_all(line, reinterpret_cast<const char*>(others.data()), others.size() * sizeof(Held)) &&
         write_all(line, bytes.data(), bytes.size());
}

std::optional<ForkedSnapshots::Orders> ForkedSnapshots::receive(int line) {
  Head head{};
  iovec part{&head, sizeof head};
  alignas(cmsghdr) Lines lines{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = lines.data();
  message.msg_controllen = lines.size();
  ssize_t got = -1;
  do {
    got = recvmsg(line, &message, MSG_WAITALL);
  } while (got < 0 && errno == EINTR);
  if (got != sizeof head || head.bytes == 0 || head.others > kMostOthers) return std::nullopt;
  Orders orders{std::string(head.bytes, '\0'), std::vector<Held>(head.others)};
  if (!read_all(line, reinterpret_cast<char*>(orders.others.data()), head.others * sizeof(Held)) ||
      !read_all(line, orders.bytes.data(), head.bytes))
    return std::nullopt;
  const cmsghdr* const beside = CMSG_FIRSTHDR(&message);
  size_t came = 0;
  if (beside != nullptr && beside->cmsg_type == SCM_RIGHTS) came = (beside->cmsg_len - CMSG_LEN(0)) / sizeof(int);
  for (size_t n = 0; n < came && n < orders.others.size(); ++n)
    std::memcpy(&orders.others[n].line, CMSG_DATA(beside) + n * sizeof(int), sizeof(int));
  orders.others.resize(std::min(came, orders.others.size()));  // the system had no room for the rest
  return orders;
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
    hold({now, ends[1], copy});
    if (++taken_ % kLookEvery == 0)
      most_ = std::clamp(held_.size() * kMostKib / std::max<size_t>(memory().own, 1), kFewest, kMost);
    thin_out();
    return std::nullopt;
  }
  const auto on_interrupt = std::signal(SIGINT, SIG_IGN);
  close(ends[1]);
  for (int line = ends[0];;) {
    const std::optional<Orders> orders = receive(line);
    if (!orders) _exit(0);
    // A new line, as the other end belongs to who goes on from here.
    std::array<int, 2> next{};
    const pid_t going_on = connected(next) ? fork() : -1;
    // A copy that slept with lines to later ones would keep them from ending.
    if (going_on != 0)
      for (const Held& other : orders->others) close(other.line);
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
    for (const Held& held : std::exchange(held_, orders->others)) close(held.line);
    hold({now, next[1], getppid()});
    std::signal(SIGINT, on_interrupt);
    return orders->bytes;
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
    if (held_[n].position > snapshot) continue;
    std::vector<Held> others = held_;
    others.erase(others.begin() + static_cast<ptrdiff_t>(n));
    if (char reply = kCannot;
        send(held_[n].line, bytes, others) && read_all(held_[n].line, &reply, 1) && reply == kGoesOn)
      _exit(0);
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
