// Each check looks at the functions that run, and at the record of who reads and writes which variable.
#include "compiler/sema/program_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/copy_check.hpp"
#include "compiler/sema/exchange_check.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/index_check.hpp"
#include "compiler/sema/position_check.hpp"
#include "compiler/sema/state_check.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/written.hpp"
#include "compiler/sema/timers.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using vm::Opcode;

constexpr int32_t kTimer0 = 2;           // set int
constexpr int32_t kStoreData = 4;        // set mem
constexpr int32_t kStartTask = 1;  // set task
constexpr uint32_t kFirstProbe = stdlib::system_variable("TpPos2_Abs"), kLastProbe = stdlib::system_variable("TpPos1_Mot");
struct GivenCommand {
  const checked::Expr* expr;
  const checked::SystemCall* call;

  int32_t word(size_t argument) const {
    const int32_t* known = std::get_if<int32_t>(&call->arguments[argument]);
    return known != nullptr ? *known : 0;
  }
};

class ProgramCheck {
 public:
  ProgramCheck(Context& context, const ProgramRoots& roots, const CommandCheck& commands)
      : context_(context), roots_(roots), kept_(commands.kept()), exchanges_(commands.exchanges()), objects_(commands.objects()) {}

  void run(const Written& written) {
    for (size_t n = 0; n < context_.program.functions.size(); ++n)
      if (roots_.alive[n])
        for (const checked::Expr* expr : context_.contents[n].calls)
          if (const auto* call = std::get_if<checked::SystemCall>(&expr->node)) commands_.push_back({expr, call});
    for (size_t n = 0; n < context_.program.functions.size(); ++n)
      if (roots_.alive[n]) written_ |= written.of(n);
    check_started();
    check_timer_interrupt();
    for (const uint32_t timer : kTimers) check_timer(timer);
    check_probe();
    check_reserved();
    check_nothing_kept();
    check_results();
    for (size_t n = 0; n < context_.program.functions.size(); ++n)
      if (roots_.alive[n])
        checked::walk_statements(context_.program.functions[n].body,
                                 [&](const checked::Stmt& stmt) { check_wear(stmt); });
  }

 private:
  const Access* access(uint32_t number) const {
    const auto found = context_.accesses.find(number);
    return found == context_.accesses.end() ? nullptr : &found->second;
  }
  bool may_be_written(uint32_t number) const {
    const Access* all = access(number);
    return all != nullptr && !(all->writers.empty() && all->takers.empty());
  }
  template <typename Is>
  const GivenCommand* find(Is is) const {
    const auto found = std::find_if(commands_.begin(), commands_.end(), is);
    return found == commands_.end() ? nullptr : &*found;
  }

  // Of an object with data, not of one that is set up for its number alone.
  bool has_data(const GivenCommand& one) const {
    const OrderBlock orders = order_block(*one.call);
    const uint32_t pointer = orders.first + (orders.result ? orders.size - 2 : orders.size - 1);
    return written_.test(pointer - 1) && written_.test(pointer);
  }

  void check_started() {
    const GivenCommand* object = find([this](const GivenCommand& one) {
      return one.call->opcode == Opcode::Scom && one.word(0) != kTransmitAcyclic && has_data(one);
    });
    const GivenCommand* start = find([](const GivenCommand& one) {
      return one.call->opcode == Opcode::ScomOn || (one.call->opcode == Opcode::ScomState && one.word(0) == 1);
    });
    if (object != nullptr && start == nullptr)
      context_.diagnostics.report(Diag::ObjectsNotStarted, object->expr->span);
  }

  void check_timer_interrupt() {
    for (const ProgramRoot& root : roots_.roots)
      if (root.start == Opcode::SetInt && root.keyword == kTimer0 && is_never_set(kReload) && is_never_set(kTimers[0]))
        context_.diagnostics.report(Diag::TimerNotSet, root.place, {context_.program.functions[root.function].name});
  }

  const AccessPlace* reader_of(uint32_t number) const {
    const Access* all = access(number);
    if (all == nullptr) return nullptr;
    const auto found = std::find_if(all->readers.begin(), all->readers.end(), [this](const AccessPlace& one) { return roots_.alive[one.function]; });
    return found == all->readers.end() ? nullptr : &*found;
  }

  // The program gives it constants at most that are no time.
  bool is_never_set(uint32_t number) const {
    const Access* all = access(number);
    if (all == nullptr) return true;
    if (!all->takers.empty()) return false;
    size_t writes = 0;
    for (size_t n = 0; n < context_.contents.size(); ++n)
      for (const checked::Expr* expr : context_.contents[n].expressions) {
        const auto* node = std::get_if<checked::Assign>(&expr->node);
        const bool here = node != nullptr && !node->op && node->target.offset == nullptr && static_cast<uint32_t>(node->target.number) == number;
        const int32_t* constant = here ? constant_value(node->value) : nullptr;
        if (constant == nullptr || *constant > 0) {
          Numbers one;
          Written::add_own(*expr, one);
          if (one.test(number)) return false;
        } else {
          ++writes;
        }
      }
    return writes > 0 || all->writers.empty();
  }

  void check_probe() {
    if (find([](const GivenCommand& one) { return one.call->opcode == Opcode::TouchProbe; }) != nullptr) return;
    for (uint32_t number = kFirstProbe; number <= kLastProbe; ++number)
      if (const AccessPlace* reader = reader_of(number))
        context_.diagnostics.report(Diag::ProbeOff, reader->span,
                                    {std::string(stdlib::find_system_variable(static_cast<uint16_t>(number))->compiler_name)});
  }

  // By tasks: a routine may well set again what its own task waits for.
  void check_timer(uint32_t timer) {
    const Access* all = access(timer);
    if (all == nullptr) return;
    const AccessPlace* reader = reader_of(timer);
    const bool reloaded = timer == kTimers[0] && may_be_written(kReload);
    if (reader != nullptr && !may_be_written(timer) && !reloaded)
      context_.diagnostics.report(Diag::NeverWritten, reader->span,
                                  {std::string(stdlib::find_system_variable(static_cast<uint16_t>(timer))->compiler_name), "read"});
    const AccessPlace* first = nullptr;
    int task = 0;
    for (const AccessPlace& writer : all->writers)
      for (const size_t root : roots_.of[writer.function]) {
        if (roots_.roots[root].is_interrupt()) continue;
        const int own = *roots_.roots[root].task();
        if (first == nullptr) {
          first = &writer;
          task = own;
        }
        if (own == task) continue;
        const auto* row = stdlib::find_system_variable(static_cast<uint16_t>(timer));
        context_.diagnostics
            .report(Diag::SharedTimer, writer.span,
                    {std::string(row->compiler_name), fmt::format("{}", timer),
                     fmt::format("{} and {}", std::min(own, task), std::max(own, task))})
            .notes.push_back({first->span, "the other task sets it here"});
        return;
      }
  }

  void check_reserved() {
    for (const auto& [number, span] : context_.raw_names) {
      if (number < stdlib::kFirstSystemVariable || number > kLastReservedVariable) continue;
      const auto* row = stdlib::find_system_variable(static_cast<uint16_t>(number));
      const bool known = row != nullptr && (row->units == stdlib::VariableUnits::A ||
                                            context_.unit.has(stdlib::Trait::NewVariables));
      if (!known)
        context_.diagnostics.report(Diag::ReservedVariable, span,
                                    {fmt::format("{}", number), fmt::format("{}", stdlib::kFirstSystemVariable),
                                     fmt::format("{}", kLastReservedVariable)});
    }
  }

  void check_nothing_kept() {
    const GivenCommand* store =
        find([](const GivenCommand& one) { return one.call->opcode == Opcode::Memorize && one.word(0) == kStoreData; });
    const GivenCommand* exchange = find([](const GivenCommand& one) { return one.call->opcode == Opcode::Movlnk; });
    if (store == nullptr || exchange != nullptr || !context_.indirect.empty()) return;
    for (uint32_t n = 0; n <= kLastNonVolatile; ++n)
      if (may_be_written(n)) return;
    for (const Variable& variable : context_.scope.variables())
      if (variable.number <= kLastNonVolatile) return;
    context_.diagnostics.report(Diag::NothingKept, store->expr->span, {fmt::format("{}", kLastNonVolatile)});
  }

  void check_results() {
    Numbers read;
    for (size_t n = 0; n < context_.program.functions.size(); ++n)
      if (roots_.alive[n])
        for (const checked::Expr* expr : context_.contents[n].expressions) mark_read(*expr, read);
    for (const GivenCommand& one : commands_) {
      const auto exchange = exchanges_.find(one.expr);
      if (exchange == exchanges_.end() || !is_used(exchange->second, read)) continue;
      const uint32_t result = order_block(*one.call).first + MovlnkMember::Result;
      const Access* all = access(result);
      const bool by_number = all != nullptr && !all->takers.empty();
      if (by_number || read.test(result) || !unread_.insert(result).second) continue;
      context_.diagnostics.report(Diag::ResultUnread, one.expr->span, {name_of(result)});
    }
  }

  // A parameter that is written, or an answer that the program reads: ReadPar and the words behind the output data.
  bool is_used(const CommandCheck::Exchange& exchange, const Numbers& read) const {
    if (exchange.own_unit) return false;
    if (exchange.writes) return true;
    if (!exchange.data || *exchange.data + MldataMember::Size > kMaxNumbers) return false;
    const uint32_t data = *exchange.data;
    bool used = read.test(data + MldataMember::ReadPar);
    for (uint32_t n = MldataMember::Input; n < MldataMember::Size; ++n) used = used || read.test(data + n);
    return used;
  }

  // What MOVLNK itself reads of its structure does not count.
  void mark_read(const checked::Expr& expr, Numbers& read) const {
    const auto mark = [&](uint32_t first, uint32_t count) {
      for (uint32_t n = first; n < first + count && n < kMaxNumbers; ++n) read.set(n);
    };
    if (const auto* load = std::get_if<checked::Load>(&expr.node)) {
      const auto number = static_cast<uint32_t>(load->place.number);
      mark(number, 1);
      const Variable* variable = load->place.offset != nullptr ? variable_of(number) : nullptr;
      if (variable != nullptr) mark(variable->number, variable->type.size());
    }
    if (const auto* copy = std::get_if<checked::CopyBlock>(&expr.node)) mark(copy->source, copy->count);
    const auto* call = std::get_if<checked::SystemCall>(&expr.node);
    if (call == nullptr || call->opcode == Opcode::Movlnk) return;
    for (const checked::Argument& argument : call->arguments)
      if (const int32_t* number = std::get_if<int32_t>(&argument); number != nullptr && *number >= 0)
        if (const Variable* variable = variable_of(static_cast<uint32_t>(*number)))
          mark(variable->number, variable->type.size());
  }

  const Variable* variable_of(uint32_t number) const {
    for (const Variable& variable : context_.scope.variables())
      if (number >= variable.number && number < variable.number + variable.type.size()) return &variable;
    return nullptr;
  }

  std::string name_of(uint32_t number) const {
    const Variable* variable = variable_of(number);
    return variable != nullptr ? variable->name : fmt::format("H{}", number);
  }

  static bool always(const checked::ExprPtr& condition) {
    const int32_t* known = constant_value(condition);
    return known != nullptr && *known != 0;
  }

  // What an endless loop does in each turn, whatever happens.
  void check_wear(const checked::Stmt& stmt) {
    checked::StmtPtr body = nullptr;
    if (const auto* node = std::get_if<checked::While>(&stmt.node); node != nullptr && always(node->condition)) body = node->body;
    if (const auto* node = std::get_if<checked::DoWhile>(&stmt.node); node != nullptr && always(node->condition)) body = node->body;
    if (const auto* node = std::get_if<checked::For>(&stmt.node);
        node != nullptr && (node->condition == nullptr || always(node->condition)))
      body = node->body;
    if (body == nullptr) return;
    turn_waits_ = has_loop(body);
    each_turn(body);
  }

  // A loop within, in which the turn may wait for something.
  bool has_loop(const checked::StmtPtr& stmt) const {
    bool found = false;
    checked::walk_statements(stmt, [&](const checked::Stmt& inner) {
      found = found || std::holds_alternative<checked::While>(inner.node) || std::holds_alternative<checked::DoWhile>(inner.node) ||
              std::holds_alternative<checked::For>(inner.node);
    });
    if (!found && stmt != nullptr)
      checked::walk(*stmt, [&](const checked::Expr& expr) {
        found = found || std::holds_alternative<checked::Call>(expr.node);
      });
    return found;
  }

  bool is_endless(const checked::Stmt& stmt) const {
    if (const auto* node = std::get_if<checked::Block>(&stmt.node))
      return std::any_of(node->body.begin(), node->body.end(), [&](const checked::StmtPtr& part) { return is_endless(*part); });
    if (const auto* node = std::get_if<checked::While>(&stmt.node)) return always(node->condition);
    if (const auto* node = std::get_if<checked::For>(&stmt.node)) return node->condition == nullptr || always(node->condition);
    return false;
  }

  // A task that never ends by itself, in a turn that waits for nothing.
  void check_restart(const checked::Expr& expr, const checked::SystemCall& call) {
    const bool starts = (call.opcode == Opcode::Task || call.opcode == Opcode::Task2) && GivenCommand{&expr, &call}.word(0) == kStartTask;
    if (!starts || !entered_.empty() || turn_waits_) return;
    const size_t task = std::get<checked::FunctionRef>(call.arguments.back()).function;
    if (is_endless(*context_.program.functions[task].body) && told_.insert(&expr).second)
      context_.diagnostics.report(Diag::TaskRestarted, expr.span, {context_.program.functions[task].name});
  }

  // False: what follows is not always reached.
  bool each_turn(const checked::StmtPtr& stmt) {
    if (stmt == nullptr) return true;
    if (const auto* node = std::get_if<checked::Block>(&stmt->node))
      return std::all_of(node->body.begin(), node->body.end(), [&](const checked::StmtPtr& part) { return each_turn(part); });
    if (const auto* node = std::get_if<checked::ExprStmt>(&stmt->node)) {
      if (node->expr != nullptr) executed(*node->expr);
      return true;
    }
    bool leaves = false;
    checked::walk_statements(stmt, [&](const checked::Stmt& inner) {
      leaves = leaves || std::holds_alternative<checked::Break>(inner.node) ||
               std::holds_alternative<checked::Continue>(inner.node) || std::holds_alternative<checked::Return>(inner.node);
    });
    return !leaves;
  }

  void executed(const checked::Expr& expr) {
    if (const auto* call = std::get_if<checked::Call>(&expr.node)) {
      if (!entered_.insert(call->function).second) return;
      each_turn(context_.program.functions[call->function].body);
      entered_.erase(call->function);
      return;
    }
    const auto* call = std::get_if<checked::SystemCall>(&expr.node);
    if (call == nullptr) return;
    if (const auto object = objects_.find(&expr); object != objects_.end() && object->second.number && told_.insert(&expr).second)
      context_.diagnostics
          .report(Diag::ObjectTwice, expr.span,
                  {fmt::format("{}", *object->second.number), object->second.receive ? "received" : "sent"})
          .notes.push_back({{}, "it stands in an endless loop, whose first turn sets it up"});
    check_restart(expr, *call);
    const bool stores = call->opcode == Opcode::Memorize && GivenCommand{&expr, call}.word(0) != 0 && GivenCommand{&expr, call}.word(0) != 2;
    if ((stores || kept_.contains(&expr)) && told_.insert(&expr).second)
      context_.diagnostics.report(Diag::MemoryWear, expr.span,
                                  {stores ? "this stores" : "ML_S_WR writes"});
  }

  Context& context_;
  const ProgramRoots& roots_;
  const std::set<const checked::Expr*>& kept_;
  const std::map<const checked::Expr*, CommandCheck::Exchange>& exchanges_;
  const std::map<const checked::Expr*, CommandCheck::Object>& objects_;
  std::vector<GivenCommand> commands_;
  Numbers written_;
  std::set<uint32_t> unread_;
  std::set<size_t> entered_;
  bool turn_waits_ = false;
  std::set<const checked::Expr*> told_;
};

}  // namespace

void check_program(Context& context, const ProgramRoots& roots, const CommandCheck& commands, const Written& written) {
  ProgramCheck(context, roots, commands).run(written);
}

void check_commands(Context& context, const ProgramRoots& roots) {
  ConstantFlow flow(context, roots);
  CommandCheck check(context, roots, flow);
  ExchangeCheck exchanges(context, roots, flow);
  flow.run(
      [&](const ConstantFlow::Point& point) {
        check(point);
        exchanges.note(point);
      },
      [&](const ConstantFlow::Unfed& unfed) { check(unfed); });
  exchanges.run();
  check_positions(context, roots);
  const Written written(context);
  check_program(context, roots, check, written);
  check_copies(context, roots, written);
  check_indexes(context, roots, written);
  check_states(context, roots, written);
}

}  // namespace ipos::compiler
