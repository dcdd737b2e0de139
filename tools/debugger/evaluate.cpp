// Expressions of the debugger: precedence climbing over the operators of C, on 32-bit numbers that wrap as
// those of the programs do.
#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>

#include "tools/debugger/values.hpp"
#include "vm/context/arithmetic.hpp"

namespace ipos::tools::debug {
namespace {

struct Operator {
  std::string_view text;
  int precedence;
};
// Longer ones first where one begins another.
constexpr std::array<Operator, 18> kOperators{{{"||", 1},
                                               {"&&", 2},
                                               {"==", 6},
                                               {"!=", 6},
                                               {"<<", 8},
                                               {">>", 8},
                                               {"<=", 7},
                                               {">=", 7},
                                               {"<", 7},
                                               {">", 7},
                                               {"|", 3},
                                               {"^", 4},
                                               {"&", 5},
                                               {"+", 9},
                                               {"-", 9},
                                               {"*", 10},
                                               {"/", 10},
                                               {"%", 10}}};
constexpr int kMostNested = 100;

class Reader {
 public:
  Reader(const runtime::Plant& plant, uint32_t station, std::string_view text, std::optional<int32_t> hits)
      : plant_(plant), station_(station), text_(text), hits_(hits) {}

  int32_t all() {
    const int32_t value = binary(1);
    expect_end();
    return value;
  }
  ValuePlace place(bool first_of_array) {
    skip();
    const ValuePlace found = take('*') ? at_number(unary()) : named(word());
    expect_end();
    if (!first_of_array) expect_one(found);
    return found;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ValueError(fmt::format("{} in '{}'", what, text_));
  }
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect_end() {
    skip();
    if (at_ != text_.size()) fail(fmt::format("'{}' is not understood", text_.substr(at_)));
  }
  std::string_view word() {
    const size_t begin = at_;
    const auto belongs = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    };
    while (at_ < text_.size() && belongs(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  const Operator* peek_operator() {
    skip();
    for (const Operator& row : kOperators)
      if (text_.substr(at_).starts_with(row.text)) return &row;
    return nullptr;
  }

  int32_t binary(int least) {
    int32_t left = unary();
    for (const Operator* row = peek_operator(); row != nullptr && row->precedence >= least;
         row = peek_operator()) {
      at_ += row->text.size();
      left = apply(row->text, left, binary(row->precedence + 1));
    }
    return left;
  }

  int32_t apply(std::string_view op, int32_t a, int32_t b) const {
    if ((op == "/" || op == "%") && b == 0) fail("division by zero");
    if (op == "||") return a != 0 || b != 0;
    if (op == "&&") return a != 0 && b != 0;
    if (op == "==") return a == b;
    if (op == "!=") return a != b;
    if (op == "<=") return a <= b;
    if (op == ">=") return a >= b;
    if (op == "<<") return vm::shift_left(a, b);
    if (op == ">>") return vm::shift_right_sign(a, b);
    switch (op[0]) {
      case '<': return a < b;
      case '>': return a > b;
      case '|': return a | b;
      case '^': return a ^ b;
      case '&': return a & b;
      case '+': return vm::add(a, b);
      case '-': return vm::subtract(a, b);
      case '*': return vm::multiply(a, b);
      case '/': return vm::divide(a, b);
      default: return vm::remainder(a, b);
    }
  }

  int32_t unary() {
    if (++nested_ > kMostNested) fail("nested too deep");
    const int32_t value = unary_inner();
    --nested_;
    return value;
  }
  int32_t unary_inner() {
    if (take('-')) return vm::subtract(0, unary());
    if (take('+')) return unary();
    if (take('!')) return unary() == 0;
    if (take('~')) return ~unary();
    if (take('*')) return read_value(at_number(unary()));
    if (take('(')) {
      const int32_t value = binary(1);
      if (!take(')')) fail("')' is missing");
      return value;
    }
    skip();
    const std::string_view text = word();
    if (text.empty()) fail("a value is missing");
    if (std::isdigit(static_cast<unsigned char>(text[0])) != 0) return number(text);
    if (text == "hits" && hits_) return *hits_;
    if (text == "numof" && take('(')) return number_of_variable();
    const ValuePlace place = named(text);
    expect_one(place);
    return read_value(place);
  }
  void expect_one(const ValuePlace& place) const {
    if (place.elements > 1)
      fail(fmt::format("'{0}' is {1} variables: {0}[0] is one", place.name, place.elements));
  }

  // numof(name): the number of the variable, the first one of a whole, as in programs.
  int32_t number_of_variable() {
    skip();
    const size_t begin = at_;
    at_ = std::min(text_.find(')', begin), text_.size());
    size_t end = at_;
    while (end > begin && std::isspace(static_cast<unsigned char>(text_[end - 1])) != 0) --end;
    const std::string_view name = text_.substr(begin, end - begin);
    if (!take(')')) fail("')' is missing");
    if (const auto whole = find_whole(plant_, station_, name)) return vm::wrap(whole->variables[0].number);
    Reader inner(plant_, station_, name, hits_);
    const ValuePlace place = inner.place(true);
    if (!place.signal->is_variable()) fail(fmt::format("'{}' is no variable", name));
    return vm::wrap(place.signal->number);
  }

  // *420 is H420.
  ValuePlace at_number(int32_t number) const {
    const auto first = find_value(plant_, station_, "H0");
    if (!first) fail("the station has no variables");
    const auto found = moved(*first, number, fmt::format("H{}", number));
    if (!found) fail(fmt::format("there is no H{}", number));
    return *found;
  }

  int32_t number(std::string_view text) const {
    const bool hex = text.starts_with("0x") || text.starts_with("0X");
    const bool binary = text.starts_with("0b") || text.starts_with("0B");
    const std::string_view digits = hex || binary ? text.substr(2) : text;
    uint64_t value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                               hex      ? 16
                                               : binary ? 2
                                                        : 10);
    if (status != std::errc() || end != digits.data() + digits.size() || value > UINT32_MAX)
      fail(fmt::format("'{}' is no number", text));
    return vm::wrap(static_cast<uint32_t>(value));
  }

  // `name`, `name[1]`, `name[1].member[2]`, `H[5]`; each index is an expression.
  ValuePlace named(std::string_view name) {
    if (name == "H" || name.ends_with(".H")) return by_number(name);
    std::string path(name);
    auto found = find_value(plant_, station_, path);
    while (take('[')) {
      const int32_t index = index_behind();
      const std::string element = fmt::format("{}[{}]", path, index);
      auto exact = find_value(plant_, station_, element);
      if (!exact && found && found->signal->is_variable()) {
        // Of an array there is nothing behind its end; programs reach what is behind a single variable.
        if (found->elements > 1 && (index < 0 || vm::bits(index) >= found->elements))
          fail(fmt::format("'{}' has {} elements", path, found->elements));
        exact = moved(*found, index, element);
      }
      found = exact;
      path = element + std::string(word());
      if (path != element) found = find_value(plant_, station_, path);
    }
    if (!found) fail(fmt::format("there is no '{}'", path));
    return *found;
  }

  ValuePlace by_number(std::string_view name) {
    const auto first = find_value(plant_, station_, fmt::format("{}0", name));
    if (!first) fail(fmt::format("there is no '{}'", name));
    if (!take('[')) fail("H needs a number: H5 or H[5]");
    const int32_t index = index_behind();
    auto found = moved(*first, index, fmt::format("{}{}", name, index));
    if (!found) fail(fmt::format("there is no {}[{}]", name, index));
    return *found;
  }

  int32_t index_behind() {
    const int32_t index = binary(1);
    if (!take(']')) fail("']' is missing");
    return index;
  }

  // The variable `index` after this one; programs reach it by a computed index, too.
  std::optional<ValuePlace> moved(const ValuePlace& place, int32_t index, const std::string& name) const {
    if (index < 0) return std::nullopt;
    return variable_place(plant_, place.station, place.signal->number + vm::bits(index), name);
  }

  const runtime::Plant& plant_;
  uint32_t station_;
  std::string_view text_;
  std::optional<int32_t> hits_;
  size_t at_ = 0;
  int nested_ = 0;
};

}  // namespace

ValuePlace evaluate_place(const runtime::Plant& plant, uint32_t station, std::string_view text,
                          bool first_of_array) {
  return Reader(plant, station, text, {}).place(first_of_array);
}

int32_t evaluate(const runtime::Plant& plant, uint32_t station, std::string_view text,
                 std::optional<int32_t> hits) {
  return Reader(plant, station, text, hits).all();
}

}  // namespace ipos::tools::debug
