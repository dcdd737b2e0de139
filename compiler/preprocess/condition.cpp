// Evaluator of #if expressions by precedence climbing. An operand that C would not evaluate may divide by
// zero.
#include "compiler/preprocess/condition.hpp"

#include "compiler/preprocess/number.hpp"

namespace ipos::compiler {
namespace {

constexpr int kMaxDepth = 256;  // ours; brackets and signs within each other

// 0: no binary operator. Classes of the language, higher binds tighter.
int precedence(TokenKind kind) {
  switch (kind) {
    case TokenKind::Star:
    case TokenKind::Slash:
    case TokenKind::Percent: return 10;
    case TokenKind::Plus:
    case TokenKind::Minus: return 9;
    case TokenKind::ShiftLeft:
    case TokenKind::ShiftRight: return 8;
    case TokenKind::Less:
    case TokenKind::LessEqual:
    case TokenKind::Greater:
    case TokenKind::GreaterEqual: return 7;
    case TokenKind::EqualEqual:
    case TokenKind::NotEqual: return 6;
    case TokenKind::And: return 5;
    case TokenKind::Xor: return 4;
    case TokenKind::Or: return 3;
    case TokenKind::AndAnd: return 2;
    case TokenKind::OrOr: return 1;
    default: return 0;
  }
}

class Evaluator {
 public:
  Evaluator(std::span<const Token> tokens, const Token& directive, Diagnostics& diagnostics)
      : tokens_(tokens), directive_(directive), diagnostics_(diagnostics) {}

  std::optional<bool> run() {
    const int32_t value = conditional(true);
    if (!failed_ && next_ < tokens_.size()) fail("an operator or the end of the line is missing");
    return failed_ ? std::nullopt : std::optional<bool>(value != 0);
  }

 private:
  TokenKind peek() const { return next_ < tokens_.size() ? tokens_[next_].kind : TokenKind::End; }

  // The first failure is reported; the rest of the evaluation only has to come to an end.
  int32_t fail(std::string reason) {
    if (!failed_) {
      Span place = directive_.span;
      if (next_ < tokens_.size())
        place = tokens_[next_].span;
      else if (!tokens_.empty())
        place = {tokens_.back().span.end, tokens_.back().span.end};
      diagnostics_.report(Diag::BadCondition, place, {std::string(directive_.text), std::move(reason)});
    }
    failed_ = true;
    return 0;
  }

  bool expect(TokenKind kind, const char* spelling) {
    if (peek() != kind) {
      fail(std::string("'") + spelling + "' is missing");
      return false;
    }
    ++next_;
    return true;
  }

  // `live`: C would evaluate this part.
  int32_t conditional(bool live) {
    const int32_t condition = binary(1, live);
    if (failed_ || peek() != TokenKind::Question) return condition;
    ++depth_;
    ++next_;
    const int32_t then = conditional(live && condition != 0);
    if (!expect(TokenKind::Colon, ":")) return 0;
    const int32_t otherwise = conditional(live && condition == 0);
    --depth_;
    return condition != 0 ? then : otherwise;
  }

  int32_t binary(int lowest, bool live) {
    int32_t left = unary(live);
    while (!failed_ && precedence(peek()) >= lowest) {
      const size_t at = next_++;
      const TokenKind op = tokens_[at].kind;
      const bool skip_right = (op == TokenKind::AndAnd && left == 0) || (op == TokenKind::OrOr && left != 0);
      const int32_t right = binary(precedence(op) + 1, live && !skip_right);
      if (!failed_) left = apply(at, left, right, live);
    }
    return left;
  }

  int32_t apply(size_t at, int32_t left, int32_t right, bool live) {
    const auto a = static_cast<uint32_t>(left);
    const auto b = static_cast<uint32_t>(right);
    switch (tokens_[at].kind) {
      case TokenKind::Star: return static_cast<int32_t>(a * b);
      case TokenKind::Slash:
      case TokenKind::Percent: return divide(at, left, right, live);
      case TokenKind::Plus: return static_cast<int32_t>(a + b);
      case TokenKind::Minus: return static_cast<int32_t>(a - b);
      case TokenKind::ShiftLeft: return static_cast<int32_t>(a << (b & 31U));
      case TokenKind::ShiftRight: return left >> (b & 31U);
      case TokenKind::Less: return left < right;
      case TokenKind::LessEqual: return left <= right;
      case TokenKind::Greater: return left > right;
      case TokenKind::GreaterEqual: return left >= right;
      case TokenKind::EqualEqual: return left == right;
      case TokenKind::NotEqual: return left != right;
      case TokenKind::And: return left & right;
      case TokenKind::Xor: return left ^ right;
      case TokenKind::Or: return left | right;
      case TokenKind::AndAnd: return left != 0 && right != 0;
      default: return left != 0 || right != 0;
    }
  }

  int32_t divide(size_t at, int32_t left, int32_t right, bool live) {
    if (right == 0) {
      if (live) next_ = at;  // points at the operator
      return live ? fail("division by zero") : 0;
    }
    const bool quotient = tokens_[at].kind == TokenKind::Slash;
    if (right == -1) return quotient ? static_cast<int32_t>(0U - static_cast<uint32_t>(left)) : 0;
    return quotient ? left / right : left % right;
  }

  int32_t unary(bool live) {
    if (failed_) return 0;
    if (depth_ >= kMaxDepth) return fail("nested too deeply");
    ++depth_;
    const int32_t value = operand(live);
    --depth_;
    return value;
  }

  int32_t operand(bool live) {
    const TokenKind kind = peek();
    switch (kind) {
      case TokenKind::Plus: ++next_; return unary(live);
      case TokenKind::Minus: ++next_; return static_cast<int32_t>(0U - static_cast<uint32_t>(unary(live)));
      case TokenKind::Not: ++next_; return unary(live) == 0;
      case TokenKind::BitNot: ++next_; return ~unary(live);
      case TokenKind::LeftParen: {
        ++next_;
        const int32_t value = conditional(live);
        expect(TokenKind::RightParen, ")");
        return value;
      }
      case TokenKind::Number: return number();
      case TokenKind::Name: {
        const Token& name = tokens_[next_++];
        if (live) diagnostics_.report(Diag::UndefinedInCondition, name.span, {std::string(name.text)});
        return 0;
      }
      default: return fail("a number or a name is missing");
    }
  }

  int32_t number() {
    const Token& token = tokens_[next_];
    const bool behind_minus = next_ > 0 && tokens_[next_ - 1].kind == TokenKind::Minus;
    const ParsedNumber parsed = parse_number(token.text, behind_minus);
    if (parsed.form == NumberForm::TooLarge)
      return fail("'" + std::string(token.text) + "' does not fit into 32 bits");
    if (parsed.form != NumberForm::Good)
      return fail("'" + std::string(token.text) + "' is not a whole number");
    ++next_;
    return static_cast<int32_t>(parsed.value);
  }

  std::span<const Token> tokens_;
  const Token& directive_;
  Diagnostics& diagnostics_;
  size_t next_ = 0;
  int depth_ = 0;
  bool failed_ = false;
};

}  // namespace

std::optional<bool> evaluate_condition(std::span<const Token> tokens, const Token& directive,
                                       Diagnostics& diagnostics) {
  return Evaluator(tokens, directive, diagnostics).run();
}

}  // namespace ipos::compiler
