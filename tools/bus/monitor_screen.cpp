// Escape sequences: the other screen of the terminal while it runs, so that what stood there comes back.
#include "tools/bus/monitor_screen.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "tools/cli/terminal.hpp"

namespace ipos::tools {
namespace {

constexpr size_t kWidthOfPipes = 160;                        // ours
constexpr auto kDrawEvery = std::chrono::milliseconds(100);  // ours
constexpr const char* kOtherScreen = "\033[?1049h\033[?25l";
constexpr const char* kBack = "\033[?25h\033[?1049l";

// Each line is cleared after its end, and so is all below.
std::string over(const std::string& text) {
  std::string out = "\033[H";
  for (const char c : text) out += c == '\n' ? std::string("\033[K\r\n") : std::string(1, c);
  return out + "\033[K\033[J";
}

}  // namespace

MonitorScreen::MonitorScreen(bool live) : live_(live) {
  if (!live_) return;
  keys_.emplace();
  fmt::print("{}", kOtherScreen);
}

MonitorScreen::~MonitorScreen() { finish(); }

void MonitorScreen::look() {
  if (!live_) return;
  while (const auto key = keys_->next()) {
    ended_ = !table_.press(*key) || ended_;
    changed_ = true;
  }
  if (!changed_ && (table_.paused() || Clock::now() - drawn_ < kDrawEvery)) return;
  draw();
}

void MonitorScreen::draw() {
  changed_ = false;
  drawn_ = Clock::now();
  const ScreenSize size = screen_size();
  fmt::print("{}", over(table_.draw(size.columns, size.rows, has_colours(STDOUT_FILENO))));
  std::fflush(stdout);
}

void MonitorScreen::finish() {
  if (finished_) return;
  finished_ = true;
  keys_.reset();
  if (live_) fmt::print("{}", kBack);
  const size_t width = is_terminal(STDOUT_FILENO) ? screen_size().columns : kWidthOfPipes;
  fmt::print("{}\n", table_.draw(width, 0, has_colours(STDOUT_FILENO)));
  std::fflush(stdout);
}

}  // namespace ipos::tools
