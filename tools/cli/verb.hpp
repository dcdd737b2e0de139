// What the command line takes, as data: verbs with their options, each said once. The parser (parser.hpp),
// --help, the man page and the completion of shells read the same rows. CLI11 stays behind the parser: its
// header alone takes seconds to read.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace ipos::tools::cli {

// Where the value of an option goes. The variable has to live until the verb has run.
using Target = std::variant<bool*, std::string*, std::vector<std::string>*, int*, uint16_t*, uint32_t*,
                            uint64_t*, std::optional<uint16_t>*>;

// Looks at the text of a value; says what is wrong with it, nothing if it is good.
using Check = std::function<std::string(const std::string&)>;

// What may stand for a value, for completion; `words` are those of the verb, the last one is being typed.
using Offer = std::function<std::vector<std::string>(const std::vector<std::string>& words)>;

class Option {
 public:
  struct Row {
    std::string names;  // "--for", "--jobs,-j"; without a dash a word of the command line: "FILE"
    std::string text;   // what it does, for --help
    Target target;
    bool is_flag = false;
    bool sets = true;     // what a flag without a value makes of its target
    std::string implied;  // of a flag that may have a value: the value it has without
    bool is_required = false;
    bool takes_one_each = false;       // each value has its option in front: -I a -I b
    char separator = 0;                // between several values in one word
    std::vector<std::string> choices;  // all values there are, if the list is closed
    std::optional<std::pair<uint64_t, uint64_t>> range;
    Check check;
    std::string kind;  // what the checked value is, in capitals: TIME, UNIT
    Offer offer;
  };

  Option(std::string names, Target target, std::string text) {
    row_.names = std::move(names);
    row_.target = target;
    row_.text = std::move(text);
  }
  const Row& row() const { return row_; }
  bool is_word() const { return row_.names.front() != '-'; }

  Option& required() { return row_.is_required = true, *this; }
  Option& one_each() { return row_.takes_one_each = true, *this; }
  Option& separated_by(char separator) { return row_.separator = separator, *this; }
  Option& one_of(std::vector<std::string> choices) { return row_.choices = std::move(choices), *this; }
  Option& between(uint64_t least, uint64_t most) { return row_.range = std::pair(least, most), *this; }
  Option& at_least(uint64_t least) { return between(least, UINT64_MAX); }
  Option& check(Check check, std::string kind) {
    row_.check = std::move(check);
    row_.kind = std::move(kind);
    return *this;
  }

  Option& offers(Offer offer) { return row_.offer = std::move(offer), *this; }

  // It has no value of its own.
  Option& set_flag(bool sets, std::string implied) {
    row_.is_flag = true;
    row_.sets = sets;
    row_.implied = std::move(implied);
    return *this;
  }

 private:
  Row row_;
};

class Verb {
 public:
  Verb(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {}
  Verb(const Verb&) = delete;
  Verb& operator=(const Verb&) = delete;

  // A verb of this verb, as `plan` of `ipos bus`. It stands under the heading of begin_group() in --help.
  Verb& verb(std::string name, std::string text);
  void begin_group(std::string heading) { inner_group_ = std::move(heading); }
  // Of shells and not of people: --help and the manual page leave it out.
  void hide() { hidden_ = true; }
  // An option with a value, or a word of the command line.
  template <typename T>
  Option& option(std::string names, T& target, std::string text) {
    return add(std::move(names), &target, std::move(text));
  }
  // An option without a value: it sets the target.
  Option& flag(std::string names, bool& target, std::string text);
  // The same, but it clears the target.
  Option& off(std::string names, bool& target, std::string text);
  // An option that may have a value (--watch, --watch=NAME); `implied` is the value without.
  Option& flag(std::string names, std::string& target, std::string implied, std::string text);
  // What stands below the help: an example.
  void footer(std::string text) { footer_ = std::move(text); }
  // What the verb does; gives the exit code.
  void runs(std::function<int()> action) { action_ = std::move(action); }

  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  const std::string& group() const { return group_; }  // its heading; empty: the usual one
  bool hidden() const { return hidden_; }
  const std::string& footer() const { return footer_; }
  const std::function<int()>& action() const { return action_; }
  const std::deque<Verb>& verbs() const { return verbs_; }
  const std::deque<Option>& options() const { return options_; }

 private:
  Option& add(std::string names, Target target, std::string text);

  std::string name_;
  std::string text_;
  std::string group_;
  std::string inner_group_;
  bool hidden_ = false;
  std::string footer_;
  std::function<int()> action_;
  std::deque<Verb> verbs_;  // whose elements stay where they are
  std::deque<Option> options_;
};

}  // namespace ipos::tools::cli
