// Starting it, and talking to it. What it does wrong is an error with a text; this process only ever waits for a bounded time.
#include "runtime/fmi_import/host_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

#include "stdlib/plain_text.hpp"

// The program, as runtime/fmi_import/host was built. It is embedded so that ipos stays one file, and so that the static ipos,
// which cannot load libraries, has one that can.
extern "C" const char ipos_fmu_host_begin[];  // NOLINT
extern "C" const char ipos_fmu_host_end[];
asm(".pushsection .rodata\n"
    ".global ipos_fmu_host_begin\n.global ipos_fmu_host_end\n"
    "ipos_fmu_host_begin: .incbin \"" IPOS_FMU_HOST "\"\n"
    "ipos_fmu_host_end: .byte 0\n"
    ".popsection\n");

namespace ipos::fmi_import {
namespace {

namespace fs = std::filesystem;
using Done = runtime::MachineRun::Done;

constexpr size_t kMostAnswer = size_t{256} << 20U;  // bytes: of a state (ours)
constexpr size_t kMostWords = 1000;                 // lines that wait to be told (ours)
constexpr size_t kLongestLine = 500;                // of them (ours)
constexpr int64_t kMillisecond = 1'000'000;
constexpr auto kEnding = 2'000 * kMillisecond;  // so long an end is waited for (ours)

int64_t clock_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Done failed(std::string why) { return tl::unexpected(std::move(why)); }

// A folder that only this user can enter.
std::optional<fs::path> new_folder() {
  std::error_code error;
  fs::path base = fs::temp_directory_path(error);
  std::string name = ((error ? fs::path("/tmp") : base) / "ipos-fmu-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) return std::nullopt;
  return fs::canonical(name, error);
}

bool write_program(const fs::path& path) {
  std::ofstream out(path, std::ios::binary);
  out.write(ipos_fmu_host_begin, ipos_fmu_host_end - ipos_fmu_host_begin);
  out.close();
  std::error_code error;
  fs::permissions(path, fs::perms::owner_all, error);
  return out.good() && !error;
}

constexpr int kLineOfHost = 3;

// In the new process, where nothing may be allocated: another thread may have held the allocator.
[[noreturn]] void become_host(const char* program, const char* folder, int line, int output) {
  // Its parent is nobody who would have to wait for it.
  if (fork() != 0) _exit(0);
  setsid();
  const int nothing = open("/dev/null", O_RDWR);
  // The line goes first: its number may be one of those that are taken next.
  const int kept = fcntl(line, F_DUPFD, 10);
  const int heard = fcntl(output, F_DUPFD, 10);
  dup2(nothing, 0);
  dup2(heard, 1);
  dup2(heard, 2);
  dup2(kept, kLineOfHost);
  if (close_range(kLineOfHost + 1, ~0U, 0) != 0)
    for (int file = kLineOfHost + 1; file < 1024; ++file) close(file);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGCHLD, SIG_DFL);
  if (chdir(folder) != 0) _exit(127);
  char name[] = "ipos-fmu-host", number[] = "3";
  char* const words[] = {name, number, const_cast<char*>(folder), nullptr};
  for (int tries = 0; tries < 100; ++tries) {
    execv(program, words);
    if (errno != ETXTBSY) break;  // another thread's child still holds the file that was written
    usleep(10'000);
  }
  _exit(127);
}

std::string signal_words(uint32_t number) {
  constexpr std::pair<int, std::string_view> kNames[] = {{SIGSEGV, "a bad address"}, {SIGBUS, "a bad address"}, {SIGFPE, "an arithmetic error"},
                                                         {SIGILL, "an illegal instruction"}, {SIGABRT, "abort()"}};
  for (const auto& [signal, name] : kNames)
    if (static_cast<uint32_t>(signal) == number) return fmt::format("the FMU crashed: {} (signal {})", name, number);
  return fmt::format("the FMU crashed (signal {})", number);
}

std::string printable_line(std::string_view line) {
  std::string text;
  while (!line.empty() && text.size() < kLongestLine) {
    const size_t size = std::max<size_t>(stdlib::utf8_length(line), 1);
    const std::string_view letter = line.substr(0, size);
    text += letter == "\t" ? " " : stdlib::is_control(letter) || (size == 1 && (letter[0] & 0x80) != 0) ? "?" : letter;
    line.remove_prefix(size);
  }
  return text;
}

std::string_view bytes_of(std::span<const double> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

HostProcess::HostProcess(Unpack unpack, Begin begin, int64_t limit)
    : unpack_(std::move(unpack)), begin_(std::move(begin)), limit_(limit) {}

// One that copies may go on with lives as long as they hold its line. Else its end is waited for, so that nothing of it is left
// behind; and who does not end in time is ended.
HostProcess::~HostProcess() {
  close_line();
  if (output_ >= 0 && !shared_ && process_ > 0) {
    const int64_t until = clock_now() + kEnding;
    std::array<char, 4096> rest{};
    bool open = true;
    while (open && wait_for(output_, until)) open = read(output_, rest.data(), rest.size()) > 0;
    if (open) kill(process_, SIGKILL);
    std::error_code error;
    if (open) fs::remove_all(folder_, error);
  }
  if (output_ >= 0) close(output_);
}

void HostProcess::close_line() {
  if (line_ >= 0) close(line_);
  line_ = -1;
}

Done HostProcess::open() {
  const auto folder = new_folder();
  if (!folder) return failed("there is no room for temporary files");
  folder_ = *folder;
  Done done = unpack_(folder_);
  if (done && !write_program(folder_ / "ipos-fmu-host")) done = failed("its program cannot be written to " + folder_.string());
  if (done) done = spawn();
  if (!done) {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  return done;
}

Done HostProcess::spawn() {
  std::array<int, 2> line{}, output{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, line.data()) != 0) return failed("there is no room for a process");
  if (pipe2(output.data(), O_CLOEXEC) != 0) {
    for (const int end : line) close(end);
    return failed("there is no room for a process");
  }
  const std::string program = (folder_ / "ipos-fmu-host").string(), folder = folder_.string();
  const pid_t child = fork();
  if (child == 0) become_host(program.c_str(), folder.c_str(), line[1], output[1]);
  close(line[1]);
  close(output[1]);
  line_ = line[0];
  output_ = output[0];
  fcntl(output_, F_SETFL, O_NONBLOCK);
  if (child < 0) return failed("there is no room for a process");
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  uint32_t process = 0;
  if (!receive(&process, sizeof process, clock_now() + limit_))
    return failed(fmt::format("its process cannot be started from {}", folder_.string()));
  process_ = static_cast<int>(process);
  return {};
}

Done HostProcess::start(std::span<const double> in, std::span<double> out) {
  if (Done done = open(); !done) return done;
  std::string values;
  if (Done done = ask(IPOS_FMU_BEGIN, begin_(folder_).bytes, values); !done) return done;
  if (Done done = ask(IPOS_FMU_START, bytes_of(in), values); !done) return done;
  return give(values, out);
}

Done HostProcess::step(int64_t at, int64_t length, std::span<const double> in, std::span<double> out) {
  const std::array<double, 2> times{static_cast<double>(at) * 1e-9, static_cast<double>(length) * 1e-9};
  std::string values;
  if (Done done = ask(IPOS_FMU_STEP, std::string(bytes_of(times)).append(bytes_of(in)), values); !done) return done;
  return give(values, out);
}

Done HostProcess::give(std::string_view values, std::span<double> out) {
  if (values.size() != out.size_bytes()) return gone();
  std::memcpy(out.data(), values.data(), values.size());
  return {};
}

std::optional<std::string> HostProcess::save() {
  std::string state;
  if (line_ < 0 || !ask(IPOS_FMU_SAVE, {}, state)) return std::nullopt;
  shared_ = true;
  return state;
}

Done HostProcess::restore(const std::string& state) {
  std::string nothing;
  return ask(IPOS_FMU_RESTORE, state, nothing);
}

Done HostProcess::ask(ipos_fmu_order order, std::string_view bytes, std::string& values) {
  if (line_ < 0) return failed("the FMU has ended");
  const int64_t until = clock_now() + limit_;
  ipos_fmu_head head{static_cast<uint32_t>(order), 0, bytes.size(), 0};
  if (!send({reinterpret_cast<const char*>(&head), sizeof head}, until) || !send(bytes, until) ||
      !receive(&head, sizeof head, until) || head.bytes > kMostAnswer || head.words > kMostAnswer)
    return gone();
  values.assign(head.bytes, '\0');
  std::string words(head.words, '\0');
  if (!receive(values.data(), values.size(), until) || !receive(words.data(), words.size(), until)) return gone();
  listen();
  if (head.what == IPOS_FMU_GOOD) {
    hear(words);
    return {};
  }
  std::string why = head.what == IPOS_FMU_SIGNAL ? signal_words(head.number) : "the FMU called exit()";
  if (head.what == IPOS_FMU_FAILED) {
    while (words.ends_with('\n')) words.pop_back();
    const size_t last = words.rfind('\n') == std::string::npos ? 0 : words.rfind('\n') + 1;
    why = words.size() > last ? "the FMU gives up: " + printable_line(std::string_view(words).substr(last + 1)) : "the FMU gives up";
    hear(std::string_view(words).substr(0, last));
  }
  close_line();
  std::error_code error;
  if (head.what != IPOS_FMU_FAILED) fs::remove_all(folder_, error);  // else its process does so
  return failed(why);
}

// It does not answer: it has ended without a word, or it takes too long.
Done HostProcess::gone() {
  listen();
  close_line();
  if (late_ && process_ > 0) kill(process_, SIGKILL);
  std::error_code error;
  fs::remove_all(folder_, error);
  return failed(late_ ? fmt::format("the FMU has not answered for {} ms; it may take `limit`", limit_ / kMillisecond)
                      : "the process of the FMU has ended");
}

// False: too late. Meanwhile its output is taken, or it would wait for that.
bool HostProcess::wait_for(int file, int64_t until) {
  for (;;) {
    const int64_t left = until - clock_now();
    if (left <= 0) return false;
    std::array<pollfd, 2> files{pollfd{file, POLLIN, 0}, pollfd{file == output_ ? -1 : output_, POLLIN, 0}};
    const int timeout = static_cast<int>(std::min<int64_t>(left / kMillisecond + 1, 60'000));
    if (poll(files.data(), files.size(), timeout) < 0 && errno != EINTR) return false;
    if (files[1].revents != 0 && file != output_) listen();
    if (files[0].revents != 0) return true;
  }
}

bool HostProcess::receive(void* data, size_t size, int64_t until) {
  for (char* at = static_cast<char*>(data); size != 0;) {
    late_ = !wait_for(line_, until);
    if (late_) return false;
    const ssize_t done = read(line_, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    size -= static_cast<size_t>(done);
  }
  return true;
}

// It reads at once what it is sent, unless it has ended; a state is no larger than what it has given itself.
bool HostProcess::send(std::string_view bytes, int64_t until) {
  while (!bytes.empty() && clock_now() < until) {
    const ssize_t done = ::send(line_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(done));
  }
  return bytes.empty();
}

void HostProcess::listen() {
  std::array<char, 4096> text{};
  for (ssize_t size = 0; (size = read(output_, text.data(), text.size())) > 0;) {
    unfinished_.append(text.data(), static_cast<size_t>(size));
    for (size_t end = 0; (end = unfinished_.find('\n')) != std::string::npos;) {
      if (words_.size() < kMostWords && end != 0)
        words_.push_back({false, printable_line(std::string_view(unfinished_).substr(0, end))});
      unfinished_.erase(0, end + 1);
    }
    if (unfinished_.size() > kLongestLine) unfinished_.resize(kLongestLine);
  }
}

void HostProcess::hear(std::string_view words) {
  while (!words.empty()) {
    const size_t end = std::min(words.find('\n'), words.size());
    if (end > 1 && words_.size() < kMostWords)
      words_.push_back({words.front() == IPOS_FMU_WARNS, printable_line(words.substr(1, end - 1))});
    words.remove_prefix(std::min(end + 1, words.size()));
  }
}

std::vector<runtime::MachineWord> HostProcess::take_words() { return std::exchange(words_, {}); }

}  // namespace ipos::fmi_import
