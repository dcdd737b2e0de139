// Which telegrams of the trace somebody wants to see, as he has written it: "id:20B -token sender:saw fault". All words must
// fit; one with a minus in front must not. docs/guide/workbench.md has the language.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools::serve {

// What a filter can look at. Its words are asked for last, since they are made.
class FilteredTelegram {
 public:
  virtual const std::string& line() const = 0;
  virtual std::optional<uint32_t> id() const = 0;  // of CAN
  virtual std::string identity() const = 0;  // decimal and hexadecimal
  virtual std::vector<uint32_t> addresses() const = 0;
  virtual std::string data() const = 0;  // in capital hexadecimal digits
  virtual size_t length() const = 0;
  virtual std::string sender() const = 0;
  virtual const std::string& words() const = 0;
  virtual bool is_error() const = 0;
  virtual bool is_remote() const = 0;
  virtual bool is_extended() const = 0;
  virtual bool is_ours() const = 0;

 protected:
  ~FilteredTelegram() = default;
};

class TraceFilter {
 public:
  // A Mistake says what is wrong with the text.
  explicit TraceFilter(std::string_view text);

  bool takes(const FilteredTelegram& telegram) const;
  // Some words are to be found in the telegram's own words, which cost something.
  bool needs_words() const { return needs_words_; }

  enum class Field : uint8_t {
#define TRACE_FIELD(name, word, what) name,
#include "tools/serve/host/trace_fields.def"
  };

 private:
  struct Range {
    uint32_t least, most;
  };
  struct Term {
    Field field = Field::Anywhere;
    bool wanted = true;
    std::vector<std::string> texts;  // one of them; small letters but of data
    std::vector<Range> ranges;
  };

  void add(Term term, const std::string& values);
  static bool fits(const Term& term, const FilteredTelegram& telegram);

  std::vector<Term> terms_;  // those that need no words first
  bool needs_words_ = false;
};

}  // namespace ipos::tools::serve
