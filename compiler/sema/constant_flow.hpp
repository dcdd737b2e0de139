// Follows constants from where the program assigns them to the commands that use them, root by root: through
// statements, loops and calls, in the order in which they are executed. Followed are the members of the structures that
// are given to MOVLNK, SCOM and VARINT, the variables that these are computed from, the watchdog, and whether the
// telegrams of the SBus are started. It says only what holds on every way: what another root, a pointer, a telegram or
// an operator may write is never known.
#pragma once

#include <functional>
#include <unordered_set>

#include "compiler/sema/context.hpp"
#include "compiler/sema/known_values.hpp"
#include "compiler/sema/program_roots.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {

class ConstantFlow {
 public:
  // Followed like variables, beyond the numbers of all variables.
  static constexpr uint32_t kSbusStarted = kMaxNumbers;  // 1 when it is
  static constexpr uint32_t kWatchdog = stdlib::system_variable("WdogTimer");
  static constexpr int32_t kWatchdogOff = -1;

  // A system command that is reached. The values are those before it.
  struct Point {
    const checked::Expr& expr;
    const checked::SystemCall& call;
    size_t function;
    size_t root;
    KnownValues::Set value;  // of its last argument that is computed; kAny without one
  };
  // A watchdog that runs for certain and is not set again for ever: where the program ends, or in an endless loop.
  struct Unfed {
    std::span<const KnownValue> watchdog;
    Span loop;  // no place: the end of the program
  };
  // An SBus object that is set up for certain.
  struct Defined {
    int32_t object;
    uint32_t structure;
    Span place;
    bool operator==(const Defined&) const = default;
  };
  using Visit = std::function<void(const Point&)>;
  using VisitUnfed = std::function<void(const Unfed&)>;

  ConstantFlow(const Context& context, const ProgramRoots& roots);

  // Calls `visit` for each command on each way that differs in values; a command may come several times.
  void run(const Visit& visit, const VisitUnfed& unfed);

  // For `visit`: values of a variable, empty when they are not known.
  std::span<const KnownValue> values(uint32_t number) const { return sets_.values(at(number)); }
  const KnownValue* only(uint32_t number) const { return sets_.only(at(number)); }
  const KnownValue* only_of(KnownValues::Set set) const { return sets_.only(set); }
  // A member of a structure of orders from which the unit only reads the variable with that number.
  bool is_read_through(uint32_t member) const { return read_only_takers_.contains(member); }
  const std::vector<Defined>& defined() const { return state_.defined; }

 private:
  using Set = KnownValues::Set;
  static constexpr uint32_t kNotFollowed = UINT32_MAX;  // of slots
  struct State {
    bool reached = true;
    std::vector<Set> values;  // by slot
    std::vector<Defined> defined;
    bool operator==(const State&) const = default;
  };
  struct Frame {
    State breaks, continues;
    const State* entry = nullptr;  // of a switch
  };
  struct Loop {
    checked::ExprPtr before, after, step;
    checked::StmtPtr body;
    Span place;
  };

  // constant_flow_setup.cpp
  void find_followed();
  void find_owners(const Context& context);
  void follow(uint32_t number);
  void follow_sources(const checked::Expr& expr);
  void note_writes(const checked::Expr& expr, size_t function);
  void note_write(uint32_t number, uint32_t count, size_t function, Set value);
  static Set zero(const Context& context, uint32_t number, KnownValues& sets);

  Set at(uint32_t number) const;
  void store(uint32_t number, Set value);
  void forget(uint32_t number, uint32_t count);
  void forget(const std::optional<NumberRange>& within);
  void forget_all();
  void join(State& into, const State& from);
  Set join_watchdog(Set a, Set b);
  void set_watchdog(Set value);
  void pass_time(int32_t ms);
  void tell_unfed(Set watchdog, Span loop) const;
  static State nowhere() { return {false, {}, {}}; }  // holds no values

  void run(const checked::StmtPtr& stmt);
  void loop(const Loop& parts);
  void choose(const checked::Switch& node);
  void call(size_t function);
  void command(const checked::Expr& expr, const checked::SystemCall& node, Set value);
  void define(const checked::Expr& expr, const checked::SystemCall& node);
  Set value_of(const checked::ExprPtr& expr);
  Set value_of(const checked::Assign& node, Span span);

  const checked::Program& program_;
  const std::vector<Contents>& contents_;
  const ProgramRoots& roots_;
  KnownValues sets_;
  std::vector<uint32_t> slots_;    // of each number
  std::vector<uint32_t> numbers_;  // of each slot
  std::vector<Set> at_first_;      // of each slot: before the program begins
  std::vector<Set> all_;           // of each slot: whatever any root gives it
  std::vector<uint64_t> writers_;  // of each slot: roots, a bit each
  std::vector<bool> relevant_;     // functions with something to follow, or a command, in them or below
  std::vector<bool> pinned_;       // of each slot: never known
  std::unordered_set<uint32_t> read_only_takers_;  // members that hold numbers of variables the unit only reads

  const Visit* visit_ = nullptr;
  const VisitUnfed* unfed_ = nullptr;
  State state_;
  State returns_;
  std::vector<Frame> frames_;
  std::vector<bool> running_;  // functions
  size_t function_ = 0;
  size_t root_ = 0;
  size_t feeds_ = 0;  // times at which the watchdog was set or stopped
  size_t exits_ = 0;  // times at which the function that runs returned
  uint32_t budget_ = 0;  // nodes still to be looked at; 0: the rest stays unsaid
};

}  // namespace ipos::compiler
