// Lines of standard input. Ctrl-C on a terminal gives a new prompt; what stood on the line is gone. A script is read without
// a buffer of the library's: what was read ahead must go with the session to the process that goes on. posix and windows have
// what is typed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools::debug {

class LineInput {
 public:
  // How a line can go on that begins so.
  using Words = std::function<std::vector<std::string>(std::string_view)>;

  LineInput();
  bool is_terminal() const { return terminal_; }
  // Nothing: the end.
  std::optional<std::string> next();
  // Where lines can be edited.
  void complete_with(Words words);
  // What was read and is no whole line yet.
  const std::string& rest() const { return rest_; }
  void set_rest(std::string rest) { rest_ = std::move(rest); }

 private:
  std::optional<std::string> next_typed();
  // False: the end.
  bool read_more();
  std::optional<std::string> line_of_rest();

  bool terminal_;
  std::string rest_;
};

}  // namespace ipos::tools::debug
