// Escape sequences: the other screen of the terminal while it runs, so that what stood there comes back.
#include "tools/bus/monitor_screen.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "tools/cli/terminal.hpp"

namespace ipos::tools {
namespace {

constexpr size_t kWidthOfPipes = 160;                        // ours
constexpr auto kDrawEvery = std::chrono::milliseconds(100);  // ours
constexpr const char* kOtherScreen = "\033[?1049h\033[?25l";
constexpr const char* kBack = "\033[?25h\033[?1049l";

winsize terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) size = {24, 100, 0, 0};
  return size;
}

// Each line is cleared after its end, and so is all below.
std::string over(const std::string& text) {
  std::string out = "\033[H";
  for (const char c : text) out += c == '\n' ? std::string("\033[K\r\n") : std::string(1, c);
  return out + "\033[K\033[J";
}

}  // namespace

MonitorScreen::MonitorScreen(bool live) : live_(live) {
  if (!live_) return;
  if (isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0) {
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    has_keys_ = tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
  }
  fmt::print("{}", kOtherScreen);
}

MonitorScreen::~MonitorScreen() { finish(); }

void MonitorScreen::look() {
  if (!live_) return;
  pollfd polled{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  while (has_keys_ && poll(&polled, 1, 0) == 1 && (polled.revents & POLLIN) != 0 &&
         ::read(STDIN_FILENO, &key, 1) == 1) {
    ended_ = !table_.press(key) || ended_;
    changed_ = true;
  }
  if (!changed_ && (table_.paused() || Clock::now() - drawn_ < kDrawEvery)) return;
  draw();
}

void MonitorScreen::draw() {
  changed_ = false;
  drawn_ = Clock::now();
  const winsize size = terminal_size();
  fmt::print("{}", over(table_.draw(size.ws_col, size.ws_row, has_colours(STDOUT_FILENO))));
  std::fflush(stdout);
}

void MonitorScreen::finish() {
  if (finished_) return;
  finished_ = true;
  if (has_keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  if (live_) fmt::print("{}", kBack);
  const size_t width = is_terminal(STDOUT_FILENO) ? terminal_size().ws_col : kWidthOfPipes;
  fmt::print("{}\n", table_.draw(width, 0, has_colours(STDOUT_FILENO)));
  std::fflush(stdout);
}

}  // namespace ipos::tools
