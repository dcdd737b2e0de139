// Rows of the command line.
#include "tools/cli/verb.hpp"

namespace ipos::tools::cli {

Verb& Verb::verb(std::string name, std::string text) {
  Verb& made = verbs_.emplace_back(std::move(name), std::move(text));
  made.group_ = inner_group_;
  return made;
}

Option& Verb::add(std::string names, Target target, std::string text) {
  return options_.emplace_back(std::move(names), target, std::move(text));
}

Option& Verb::flag(std::string names, bool& target, std::string text) {
  return add(std::move(names), &target, std::move(text)).set_flag(true, {});
}

Option& Verb::off(std::string names, bool& target, std::string text) {
  return add(std::move(names), &target, std::move(text)).set_flag(false, {});
}

Option& Verb::flag(std::string names, std::string& target, std::string implied, std::string text) {
  return add(std::move(names), &target, std::move(text)).set_flag(true, std::move(implied));
}

}  // namespace ipos::tools::cli
