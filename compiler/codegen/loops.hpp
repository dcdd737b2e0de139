// What a loop does to the variables: which of them it moves by constants only, and which numbers of elements it computes in each turn.
#pragma once

#include <array>
#include <bitset>
#include <functional>
#include <optional>
#include <vector>

#include "compiler/codegen/linear.hpp"
#include "compiler/sema/ranges.hpp"

namespace ipos::compiler {

// Null where the loop has none.
struct LoopParts {
  checked::ExprPtr init = nullptr;
  checked::ExprPtr condition = nullptr;
  checked::ExprPtr step = nullptr;
  checked::StmtPtr body = nullptr;
};

struct Bounds {
  int64_t least = 0;
  int64_t most = 0;
};

// A variable that has these values in the body of its loop.
struct Counter {
  int32_t variable = 0;
  Bounds bounds;
};

// A case of a switch around it: a way in beside the beginning.
bool has_way_in(const checked::StmtPtr& stmt);
// It lets others go on meanwhile, or may write more than its operands say.
bool is_of_the_host(const checked::SystemCall& call);

class LoopScan {
 public:
  // A number that each turn computes.
  struct Use {
    Linear number;
    const checked::Expr* value = nullptr;  // or of the place
    const checked::Place* place = nullptr;
    const checked::Expr* assignment = nullptr;  // the statement, if it is one
  };
  using Variables = std::bitset<kMaxNumbers>;

  // `stays`: nobody else writes the variable. `around`: of the loops around this one.
  LoopScan(const LoopParts& loop, std::function<bool(int32_t)> stays, std::vector<Counter> around);

  const std::vector<Use>& uses() const { return uses_; }
  // Whether it changes in no way but by the moves of the loop.
  bool moves_only(int32_t variable) const { return variable < static_cast<int32_t>(kMaxNumbers) && !changed_.test(static_cast<size_t>(variable)) && stays_(variable); }
  // How often a turn at most moves a number, outside of the loops within.
  size_t moves(const Linear& number) const;
  // Whether it ends by what it counts, and lets nobody else go on meanwhile.
  bool is_counted() const { return condition_ != nullptr && counts(*condition_); }
  const std::optional<Counter>& counter() const { return counter_; }

 private:
  struct At {
    bool certain = true;     // each turn comes by
    bool inner = false;      // in a loop within the loop
    bool condition = false;  // of the loop: without it there is no next turn
    const checked::Expr* assignment = nullptr;
  };

  void statement(const checked::StmtPtr& stmt, At at);
  void inner_loop(const LoopParts& loop, At at, bool has_turn);
  void effect(const checked::Expr& expr, At at);
  void expression(const checked::Expr& expr, At at);
  void place(const checked::Place& place, At at);
  void write(const checked::Place& place);
  void write(int64_t first, int64_t last, Variables& variables);
  std::optional<Counter> counter_of(const LoopParts& loop) const;
  std::optional<Bounds> bounds(const checked::Expr& expr) const;
  bool counts(const checked::Expr& condition) const;

  std::function<bool(int32_t)> stays_;
  const checked::Expr* condition_;
  std::vector<Use> uses_;
  std::array<MoveBy, 8> moves_{};  // more are in no loop that is worth it
  size_t move_count_ = 0;
  Variables changed_;   // otherwise than by moves
  Variables computed_;  // of them by a place that is computed
  std::vector<Counter> counters_;  // of the loops around the place that is looked at
  Variables assumed_;              // counters that no computed place may be
  std::optional<Counter> counter_;
  int depth_ = 0;
};

}  // namespace ipos::compiler
