// Statements and functions.
#include "tests/generated/program_generator.hpp"

#include <optional>
#include <set>
#include <utility>

#include "tests/generated/expression_generator.hpp"
#include "tests/generated/source_text.hpp"

namespace ipos::tests {
namespace {

// In braces, so that random choices of the parts are made in order.
struct Parts {
  StmtKind kind;
  std::vector<Expr> exprs = {};
  std::vector<Stmt> body = {};
};

Stmt make(Parts parts) {
  Stmt out;
  out.kind = parts.kind;
  out.exprs = std::move(parts.exprs);
  out.body = std::move(parts.body);
  return out;
}

class Generator {
 public:
  Generator(uint64_t seed, bool unguarded) : random_(seed) {
    program_.seed = seed;
    if (random_.one_in(8)) {
      program_.unit = "mdxb";
      program_.variables = 1024;
    }
    program_.head.push_back("// Generated program " + std::to_string(seed) +
                            (unguarded ? ", unguarded" : ""));
    objects_ = declare(random_, program_);
    constants_ = static_cast<int>(objects_.macros.size());
    expressions_.emplace(random_, objects_, budget_, unguarded, program_.variables);
    budget_.nodes = 60;
    macros();
  }

  Program run() {
    const int count = random_.between(0, 4);
    budget_.functions.assign(static_cast<size_t>(count) + 1, 0);
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i)
      names.push_back((random_.one_in(2) ? "Func" : "do_it_") + std::to_string(i));
    names.push_back("main");
    program_.functions.resize(names.size());
    for (size_t i = 0; i < names.size(); ++i) {
      program_.functions[i].name = names[i];
      // md60a holds 2048 words.
      budget_.nodes = i + 1 == names.size() ? 250 : 80;
      budget_.cost = 1;
      program_.functions[i].body = block(random_.between(2, 5) + (names[i] == "main" ? 8 : 0), 3, false);
      if (names[i] == "main") start_values(program_.functions[i].body);
      program_.functions[i].before = lines_before();
      budget_.functions[i] = budget_.cost;
    }
    shuffle();
    return std::move(program_);
  }

 private:
  void start_values(Stmt& body) {
    std::vector<Stmt> first;
    for (const Named& variable : objects_.hot)
      first.push_back(make({StmtKind::Effect, {expressions_->start_value(variable)}}));
    for (int i = 0; i < 4; ++i)
      first.push_back(make({StmtKind::Effect, {expressions_->start_value(random_.pick(objects_.scalars))}}));
    body.body.insert(body.body.begin(), first.begin(), first.end());
  }

  // Functions may be called before they are written; the index in a call is the place in the source.
  void shuffle() {
    std::vector<size_t> place(program_.functions.size());
    for (size_t i = 0; i < place.size(); ++i) place[i] = i;
    for (size_t i = place.size(); i > 1; --i)
      std::swap(place[i - 1], place[static_cast<size_t>(random_.below(static_cast<int>(i)))]);
    std::vector<Function> shuffled(place.size());
    for (size_t i = 0; i < place.size(); ++i) shuffled[place[i]] = std::move(program_.functions[i]);
    program_.functions = std::move(shuffled);
    program_.main = place.back();
    for (Function& function : program_.functions) redirect(function.body, place);
  }
  void redirect(Stmt& stmt, const std::vector<size_t>& place) {
    for (Expr& expr : stmt.exprs) redirect(expr, place);
    for (Stmt& inner : stmt.body) redirect(inner, place);
  }
  void redirect(Expr& expr, const std::vector<size_t>& place) {
    if (expr.kind == ExprKind::Call) {
      expr.value = static_cast<int32_t>(place[static_cast<size_t>(expr.value)]);
      expr.text = program_.functions[static_cast<size_t>(expr.value)].name + "()";
    }
    for (Expr& part : expr.parts) redirect(part, place);
  }

  std::vector<std::string> lines_before() {
    switch (random_.below(8)) {
      case 0: return {"", "/* comment with ; } and \xE4\xF6 */"};
      case 1: return {"#if 0", "this is no program, but \"it\" is not read", "#else", "// used", "#endif"};
      case 2: return {"#ifdef NOT_DEFINED_ANYWHERE", "long nothing[;", "#endif"};
      case 3: return {"#if K0 == K0 && !defined(Q) && (1 << 3) > 7", "#else", "#error never", "#endif"};
      default: return {};
    }
  }

  void macros() {
    for (int i = 0; i < 2; ++i) {
      Expr value;
      value.kind = ExprKind::Macro;
      value.text = "VALUE" + std::to_string(i);
      value.parts = {expressions_->value(2)};
      program_.head.push_back("#define " + value.text + " (" + expression_text(value.parts[0]) + ")");
      objects_.macros.push_back(value);
    }
    Expr effect;
    effect.kind = ExprKind::Macro;
    effect.text = "EFFECT";
    effect.parts = {expressions_->effect(2)};
    program_.head.push_back("#define EFFECT " + expression_text(effect.parts[0]));
    if (effect.parts[0].kind == ExprKind::Assign || effect.parts[0].kind == ExprKind::Step)
      statement_macro_ = effect;
  }

  Stmt block(int count, int depth, bool in_loop) {
    Stmt out = make({StmtKind::Block});
    for (int i = 0; i < count && budget_.nodes > 0; ++i) out.body.push_back(statement(depth, in_loop));
    return out;
  }

  Stmt effect() {
    if (statement_macro_ && random_.one_in(20)) return make({StmtKind::Effect, {*statement_macro_}});
    return make({StmtKind::Effect, {expressions_->effect(random_.between(1, 5))}});
  }

  // One statement for a branch: a block, or a simple one without braces.
  Stmt branch(int depth, bool in_loop) {
    if (depth > 0 && !random_.one_in(3)) return block(random_.between(0, 3), depth, in_loop);
    return random_.one_in(12) ? make({StmtKind::Empty}) : effect();
  }

  Stmt statement(int depth, bool in_loop) {
    const int form = depth <= 0 ? 0 : random_.below(40);
    if (form < 20) return effect();
    if (form < 26) return choice(depth, in_loop);
    if (form < 32) return loop(depth);
    if (form < 35) return choose(depth, in_loop);
    if (form == 35) return block(random_.between(0, 3), depth - 1, in_loop);
    if (form == 36) return make({StmtKind::Empty});
    if (in_loop) return leave(random_.one_in(2) ? StmtKind::Break : StmtKind::Continue);
    return random_.one_in(3) ? leave(StmtKind::Return) : effect();
  }

  // Seldom without a condition, as nothing behind it is done then.
  Stmt leave(StmtKind kind) {
    if (random_.one_in(20)) return make({kind});
    return make({StmtKind::If, {expressions_->value(2)}, {make({kind})}});
  }

  Stmt choice(int depth, bool in_loop) {
    Stmt out = make({StmtKind::If, {expressions_->value(random_.between(1, 4))}});
    const int form = random_.below(6);
    if (form == 0) {  // if (a) if (b) ...; else ...;  the else belongs to the second
      out.body.push_back(make({StmtKind::If, {expressions_->value(2)}, {branch(0, in_loop)}}));
      if (random_.one_in(2)) out.body[0].body.push_back(branch(depth - 1, in_loop));
      return out;
    }
    out.body.push_back(branch(depth - 1, in_loop));
    if (form == 1) out.body.push_back(choice(depth - 1, in_loop));
    if (form > 3) out.body.push_back(branch(depth - 1, in_loop));
    return out;
  }

  Stmt choose(int depth, bool in_loop) {
    Stmt out = make({StmtKind::Switch});
    out.exprs = {random_.one_in(3) ? expressions_->value(3)
                                   : expressions_->binary({Op::And, expressions_->value(2), number_of(7)})};
    const int labels = random_.below(7);
    const int place_of_default = random_.between(-1, labels);
    std::set<int32_t> used;
    if (random_.one_in(12)) out.body.push_back(effect());  // never reached
    for (int i = 0; i <= labels; ++i) {
      if (i == place_of_default) out.body.push_back(make({StmtKind::Default}));
      Expr label = case_value();
      const int32_t value = constant_of(label);
      if (i < labels && used.insert(value).second) {
        out.body.push_back(make({StmtKind::Case, {std::move(label)}}));
        out.body.back().value = value;
      }
      const bool labelled = !used.empty() || (place_of_default >= 0 && i >= place_of_default);
      const int statements = random_.below(3);
      for (int s = 0; s < statements && labelled; ++s) out.body.push_back(statement(depth - 1, in_loop));
      if (!random_.one_in(3) && labelled) out.body.push_back(make({StmtKind::Break}));
    }
    return out;
  }

  Expr case_value() {
    if (random_.one_in(6)) return objects_.macros[static_cast<size_t>(random_.below(constants_))];
    if (random_.one_in(8))
      return expressions_->binary({Op::Add, number_of(random_.below(4)), number_of(random_.below(4))});
    return number_of(random_.one_in(4) ? random_.between(-100, 1000) : random_.between(-2, 8));
  }

  static int32_t constant_of(const Expr& expr) {
    if (expr.kind == ExprKind::Macro) return constant_of(expr.parts[0]);
    if (expr.kind == ExprKind::Unary) return -constant_of(expr.parts[0]);
    if (expr.kind == ExprKind::Binary) return constant_of(expr.parts[0]) + constant_of(expr.parts[1]);
    return expr.value;
  }

  Stmt loop(int depth) {
    if (next_counter_ == objects_.counters.size() || budget_.times > 200) return effect();
    const Expr counter = variable_of(objects_.counters[next_counter_++]);
    const int turns = random_.between(0, 5);
    ExpressionGenerator& e = *expressions_;
    const uint64_t times = budget_.times;
    budget_.times *= static_cast<uint64_t>(turns) + 2;
    const auto body = [&] { return branch(depth - 1, true); };
    // A second condition can only end the loop earlier.
    const auto with_more = [&](Expr condition) {
      if (!random_.one_in(4)) return condition;
      return e.binary({Op::LogicalAnd, std::move(condition), e.value(2)});
    };
    Stmt start = make({StmtKind::Effect, {e.assign({counter, number_of(turns)})}});
    Stmt out;
    switch (random_.below(7)) {
      case 0:
      case 1:
        out = make(
            {StmtKind::For,
             {e.assign({counter, number_of(0)}), with_more(e.binary({Op::Lt, counter, number_of(turns)})),
              e.step({counter, 1, random_.one_in(2)})}});
        if (random_.one_in(4)) out.exprs[0] = e.comma({out.exprs[0], e.effect(1)});
        if (random_.one_in(4)) out.exprs[2] = e.comma({e.effect(1), out.exprs[2]});
        out.body = {body()};
        break;
      case 2:
        out = make({StmtKind::For,
                    {e.assign({counter, number_of(turns)}), counter, e.step({counter, -1, false})},
                    {body()}});
        break;
      case 3: {  // for (;;) left by break
        Stmt inside = block(random_.between(0, 2), depth - 1, true);
        inside.body.insert(
            inside.body.begin(),
            make({StmtKind::If, {e.binary({Op::Ge, counter, number_of(turns)})}, {make({StmtKind::Break})}}));
        out = make({StmtKind::For,
                    {e.assign({counter, number_of(0)}), Expr{}, e.step({counter, 1, false})},
                    {inside}});
        break;
      }
      case 4:
        out = make({StmtKind::Block,
                    {},
                    {start, make({StmtKind::While,
                                  {with_more(e.binary({Op::Gt, e.step({counter, -1, false}), number_of(0)}))},
                                  {body()}})}});
        break;
      case 5: {
        Stmt inside = block(random_.between(0, 3), depth - 1, true);
        inside.body.insert(inside.body.begin(), make({StmtKind::Effect, {e.step({counter, -1, true})}}));
        out = make(
            {StmtKind::Block,
             {},
             {start,
              make({StmtKind::While, {with_more(e.binary({Op::Gt, counter, number_of(0)}))}, {inside}})}});
        break;
      }
      default:
        out = make({StmtKind::Block,
                    {},
                    {start, make({StmtKind::DoWhile,
                                  {with_more(e.binary({Op::Gt, e.step({counter, -1, true}), number_of(0)}))},
                                  {body()}})}});
    }
    budget_.times = times;
    return out;
  }

  Pcg random_;
  Program program_;
  Objects objects_;
  Budget budget_;
  std::optional<ExpressionGenerator> expressions_;
  std::optional<Expr> statement_macro_;
  int constants_ = 0;
  size_t next_counter_ = 0;
};

}  // namespace

Program generate_program(uint64_t seed, bool unguarded) { return Generator(seed, unguarded).run(); }

}  // namespace ipos::tests
