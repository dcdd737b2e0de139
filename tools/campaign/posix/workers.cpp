// Workers are forked copies of this process, so that what was read and compiled is there in each. A worker gets numbers of cases
// over a pipe, a batch at a time, and gives back lines; in a page that both see it notes which case it is at, and since when.
#include "tools/campaign/workers.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <memory>

#include "runtime/os_port/descriptor.hpp"
#include "tools/campaign/machine.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools::campaign {
namespace {

using runtime::Descriptor;
using Clock = std::chrono::steady_clock;

constexpr size_t kBatch = 256;        // cases at most; lines of few KB each fill a pipe soon
constexpr size_t kLines = 32'768;     // bytes that are given back at once
constexpr int kLookMs = 50;             // ms between two looks at the clock
constexpr auto kLatest = std::chrono::milliseconds(200);  // then lines are given back, however few

int64_t now_ns() { return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count(); }

// What a worker is at; both processes see it.
struct Board {
  std::atomic<uint64_t> number;
  std::atomic<int64_t> since;  // 0: at none
};

constexpr std::string_view kExtra = "\x01";  // begins a line that is no result; JSON never does

// --- in the worker ---

class Worker {
 public:
  Worker(const WorkOrder& order, CaseRunner& runner, const WorkListener& listener, Board& board, int orders, int lines)
      : order_(order), runner_(runner), listener_(listener), board_(board), orders_(orders), lines_(lines) {}

  [[noreturn]] void run() {
    std::array<uint64_t, kBatch + 1> batch{};
    while (take(batch)) {
      for (size_t n = 1; n <= batch[0]; ++n) run_case(batch[n]);
      flush();
    }
    if (listener_.extra) {
      text_ = std::string(kExtra) + listener_.extra() + "\n";
      flush();
    }
    _exit(0);
  }

 private:
  // A whole batch, the count in front; false at the end of all.
  bool take(std::array<uint64_t, kBatch + 1>& batch) {
    auto* bytes = reinterpret_cast<char*>(batch.data());
    size_t have = 0;
    for (size_t want = sizeof(uint64_t); have < want; want = sizeof(uint64_t) * (1 + batch[0])) {
      const ssize_t got = read(orders_, bytes + have, want - have);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      have += static_cast<size_t>(got);
    }
    return true;
  }

  void run_case(uint64_t number) {
    board_.number = number;
    board_.since = now_ns();
    const uint64_t id = order_.case_of(number, levels_);
    const Outcome outcome = runner_.run(levels_);
    order_.writer.append(text_, id, levels_, outcome.measures, outcome.failed, outcome.hash ? hex(*outcome.hash) : "", outcome.ms);
    board_.since = 0;
    if (text_.size() >= kLines || Clock::now() - given_ >= kLatest) flush();
  }

  void flush() {
    for (std::string_view rest = text_; !rest.empty();) {
      const ssize_t done = write(lines_, rest.data(), rest.size());
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) _exit(1);  // nobody listens any more
      rest.remove_prefix(static_cast<size_t>(done));
    }
    text_.clear();
    given_ = Clock::now();
  }

  const WorkOrder& order_;
  CaseRunner& runner_;
  const WorkListener& listener_;
  Board& board_;
  int orders_;
  int lines_;
  Levels levels_;
  std::string text_;
  Clock::time_point given_ = Clock::now();
};

// --- in the process that has the shard ---

struct Hand {  // a worker, seen from here
  pid_t process = 0;
  Descriptor orders, lines;
  Board* board = nullptr;
  std::deque<uint64_t> batch;  // its cases that are not back
  std::string text;            // of it what is no whole line yet
  bool too_long = false;       // its case took longer than it may
  bool resting = false;        // it has been told that there is no more
};

class Crew {
 public:
  Crew(const WorkOrder& order, CaseRunner& runner, const WorkListener& listener)
      : order_(order), runner_(runner), listener_(listener), left_(order.numbers.begin(), order.numbers.end()) {
    const size_t jobs = std::clamp<size_t>(order.jobs, 1, std::max<size_t>(left_.size(), 1));
    void* page = mmap(nullptr, sizeof(Board) * jobs, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) throw Failure(kIoError, fmt::format("no memory for workers: {}", std::strerror(errno)));
    for (size_t n = 0; n < jobs; ++n) hands_.emplace_back().board = new (static_cast<Board*>(page) + n) Board();
    page_ = page;
  }
  ~Crew() {
    for (Hand& hand : hands_) end(hand);
    munmap(page_, sizeof(Board) * hands_.size());
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  void run() {
    std::signal(SIGPIPE, SIG_IGN);
    for (Hand& hand : hands_) begin(hand);
    while (listener_.go_on() && std::any_of(hands_.begin(), hands_.end(), [](const Hand& one) { return one.process != 0; })) {
      wait();
      for (Hand& hand : hands_) stop_what_hangs(hand);
    }
  }

 private:
  void begin(Hand& hand) {
    if (left_.empty()) return;
    int orders[2];
    int lines[2];
    if (pipe2(orders, O_CLOEXEC) != 0 || pipe2(lines, O_CLOEXEC) != 0)
      throw Failure(kIoError, fmt::format("no worker can be started: {}", std::strerror(errno)));
    hand.orders = Descriptor(orders[1]);
    hand.lines = Descriptor(lines[0]);
    const Descriptor its_orders(orders[0]);
    const Descriptor its_lines(lines[1]);
    hand.board->since = 0;
    hand.too_long = hand.resting = false;
    const pid_t parent = getpid();
    hand.process = fork();
    if (hand.process < 0) throw Failure(kIoError, fmt::format("no worker can be started: {}", std::strerror(errno)));
    if (hand.process == 0) {
      std::signal(SIGINT, SIG_IGN);  // its owner has it, too, and ends in good order
      std::signal(SIGTERM, SIG_DFL);
#ifdef __linux__
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);
#endif
      // The ends of the others' pipes would keep them open.
      for (Hand& other : hands_) {
        other.orders = Descriptor();
        other.lines = Descriptor();
      }
      Worker(order_, runner_, listener_, *hand.board, its_orders.get(), its_lines.get()).run();
    }
    give(hand);
  }

  // The next cases; none any more ends it.
  void give(Hand& hand) {
    // Towards the end batches are small, so that no worker has work for long while others have none.
    const size_t count = std::min({kBatch, left_.size(), std::max<size_t>(1, left_.size() / (4 * hands_.size()))});
    if (count == 0) {
      hand.orders = Descriptor();
      hand.resting = true;
      return;
    }
    std::array<uint64_t, kBatch + 1> batch{count};
    for (size_t n = 1; n <= count; ++n) {
      batch[n] = left_.front();
      hand.batch.push_back(left_.front());
      left_.pop_front();
    }
    // Where it has died meanwhile its lines end, and that is seen.
    write_whole(hand.orders, {reinterpret_cast<const char*>(batch.data()), sizeof(uint64_t) * (1 + count)});
  }

  void wait() {
    std::vector<pollfd> ends;
    for (const Hand& hand : hands_) ends.push_back({hand.process == 0 ? -1 : hand.lines.get(), POLLIN, 0});
    if (poll(ends.data(), ends.size(), kLookMs) <= 0) return;
    for (size_t n = 0; n < hands_.size(); ++n)
      if (ends[n].revents != 0) hear(hands_[n]);
  }

  void hear(Hand& hand) {
    std::array<char, 65'536> bytes;
    const ssize_t got = read(hand.lines.get(), bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) return;
    if (got <= 0) return lose(hand);
    hand.text.append(bytes.data(), static_cast<size_t>(got));
    const size_t end = hand.text.rfind('\n');
    if (end == std::string::npos) return;
    std::string_view whole(hand.text.data(), end + 1);
    const size_t extra = whole.find(kExtra);
    if (extra != std::string_view::npos) listener_.on_extra(std::string(whole.substr(extra + 1, whole.size() - extra - 2)));
    whole = whole.substr(0, extra);
    if (!whole.empty()) {
      const auto cases = static_cast<uint64_t>(std::count(whole.begin(), whole.end(), '\n'));
      hand.batch.erase(hand.batch.begin(), hand.batch.begin() + static_cast<std::ptrdiff_t>(cases));
      listener_.on_lines(whole, cases);
    }
    hand.text.erase(0, end + 1);
    if (hand.batch.empty() && !hand.resting) give(hand);
  }

  void stop_what_hangs(Hand& hand) {
    const int64_t since = hand.process == 0 ? 0 : hand.board->since.load();
    if (since == 0 || hand.too_long || now_ns() - since < order_.campaign.limit) return;
    hand.too_long = true;
    kill(hand.process, SIGKILL);  // its lines end then
  }

  // Its lines have ended: it is done, or dead. The case that it was at is a result, those that are not back are run again.
  void lose(Hand& hand) {
    int status = 0;
    while (waitpid(hand.process, &status, 0) < 0 && errno == EINTR) {
    }
    hand.process = 0;
    hand.text.clear();
    if (hand.batch.empty()) return begin(hand);
    const bool in_case = hand.board->since.load() != 0;
    const uint64_t at = hand.board->number.load();
    std::string line;
    uint64_t cases = 0;
    for (const uint64_t number : hand.batch) {
      if (!in_case || number != at) {
        left_.push_front(number);
        continue;
      }
      Levels levels;
      const uint64_t id = order_.case_of(number, levels);
      const double ms = static_cast<double>(now_ns() - hand.board->since.load()) / 1e6;
      order_.writer.append(line, id, levels, {}, {hand.too_long ? "time" : death(status)}, "", ms);
      ++cases;
    }
    // One that dies between its cases has no case to blame: that must not go on for ever.
    if (cases == 0 && ++died_idle_ > 3)
      throw Failure(kInternal, "workers die between two cases: " + death(status));
    hand.batch.clear();
    if (cases != 0) listener_.on_lines(line, cases);
    begin(hand);
  }

  static std::string death(int status) {
    if (WIFSIGNALED(status)) return fmt::format("died: signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return fmt::format("died: exit code {}", WEXITSTATUS(status));
  }

  static void end(Hand& hand) {
    if (hand.process == 0) return;
    kill(hand.process, SIGKILL);
    while (waitpid(hand.process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  const WorkOrder& order_;
  CaseRunner& runner_;
  const WorkListener& listener_;
  std::deque<uint64_t> left_;
  std::vector<Hand> hands_;
  void* page_ = nullptr;
  int died_idle_ = 0;
};

}  // namespace

void run_cases(const WorkOrder& order, CaseRunner& runner, const WorkListener& listener) {
  if (order.numbers.empty()) return;
  std::fflush(nullptr);  // a copy would print again what is not printed yet
  Crew(order, runner, listener).run();
}

}  // namespace ipos::tools::campaign
