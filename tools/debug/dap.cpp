// Requests of the debug adapter protocol: the session, running, what stops.
#include "tools/debug/dap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/diag/places.hpp"
#include "runtime/signals/find.hpp"
#include "tools/cli/failure.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/lsp_base/transport.hpp"

namespace ipos::tools::debug {
namespace {

// A pause after a further order ends the run in front of that order after this time on the clock (ours); a loaded machine
// reaches the breakpoints of a short run before.
constexpr std::chrono::seconds kLongestWait{5};
constexpr int kTaskNumbers = 4;  // thread = station x this + task + 1, as 0 is none

std::string command_of(const Json& message) {
  const auto command = message.find("command");
  return command != message.end() && command->is_string() ? command->get<std::string>() : std::string();
}

// What ends a run that is under way.
bool stops_running(const Json& message) {
  const std::string command = command_of(message);
  return command == "pause" || command == "disconnect" || command == "terminate";
}

// What runs the plant once it is handled.
bool gives_order(const Json& message) {
  static constexpr std::string_view kOrders[] = {"configurationDone", "continue", "next",   "stepIn",
                                                 "stepOut",           "stepBack", "restart", "reverseContinue"};
  return std::find(std::begin(kOrders), std::end(kOrders), command_of(message)) != std::end(kOrders);
}

}  // namespace

struct DapServer::Request {
  std::string_view command;
  Handler handle;
  bool looks = false;  // works at a run that is only looked at, too
};

const std::vector<DapServer::Request>& DapServer::requests() {
  using S = DapServer;
  static const std::vector<Request> kRequests = {
      {"initialize", &S::initialize, true},
      {"launch", &S::launch},
      {"attach", &S::attach, true},
      {"configurationDone", &S::configured, true},
      {"setBreakpoints", &S::set_breakpoints},
      {"setInstructionBreakpoints", &S::set_instruction_breakpoints},
      {"dataBreakpointInfo", &S::data_breakpoint_info},
      {"setDataBreakpoints", &S::set_data_breakpoints},
      {"setExceptionBreakpoints", &S::set_exception_breakpoints},
      {"setFunctionBreakpoints", &S::set_function_breakpoints},
      {"threads", &S::threads, true},
      {"stackTrace", &S::stack_trace, true},
      {"source", &S::source, true},
      {"scopes", &S::scopes, true},
      {"variables", &S::variables, true},
      {"setVariable", &S::set_variable},
      {"setExpression", &S::set_expression},
      {"evaluate", &S::evaluate_text, true},
      {"completions", &S::completions, true},
      {"restart", &S::restart},
      {"disassemble", &S::disassemble, true},
      {"breakpointLocations", &S::breakpoint_locations, true},
      {"exceptionInfo", &S::exception_info},
      {"readMemory", &S::read_memory, true},
      {"gotoTargets", &S::goto_targets},
      {"goto", &S::go_to},
      {"loadedSources", &S::loaded_sources, true},
      {"who", &S::who},  // ours
      {"continue", &S::resume},
      {"next", &S::next},
      {"stepIn", &S::step_in},
      {"stepOut", &S::step_out},
      {"stepBack", &S::step_back},
      {"reverseContinue", &S::reverse_continue},
      {"pause", &S::pause},
      {"disconnect", &S::disconnect, true},
      {"terminate", &S::terminate, true},
  };
  return kRequests;
}

void DapServer::receive(std::string_view body) {
  Json message = lsp::parsed(body);
  if (!message.is_object()) return;
  queue_.push_back(std::move(message));
}

bool DapServer::handle_next() {
  if (queue_.empty()) return false;
  const Json message = std::move(queue_.front());
  queue_.pop_front();
  answer(message);
  return true;
}

// The text of no exception but ours reaches the editor: others are about our code, not about what was asked.
void DapServer::answer(const Json& message) {
  const std::string command = command_of(message);
  const auto seq = message.find("seq");
  Json answer{{"type", "response"},
              {"request_seq", seq != message.end() && seq->is_number_integer() ? seq->get<int64_t>() : 0},
              {"success", true},
              {"command", command}};
  const auto refuse = [&answer](const std::string& why) {
    answer["success"] = false;
    answer["message"] = why;
  };
  try {
    const Request* found = nullptr;
    for (const Request& request : requests())
      if (request.command == command) found = &request;
    if (found == nullptr) throw ValueError(fmt::format("'{}' is not known", compiler::printable(command)));
    const auto arguments = message.find("arguments");
    const bool some = arguments != message.end() && arguments->is_object();
    const Json given = some ? *arguments : Json::object();
    if (only_looks()) debugger_->look();
    answer["body"] = only_looks() && !found->looks ? look_instead(command, given) : (this->*found->handle)(given);
  } catch (const ValueError& error) {
    refuse(error.what());
  } catch (const Failure& failure) {
    refuse(failure.what()[0] == '\0' ? "see the messages of ipos" : failure.what());
  } catch (const Json::exception&) {
    refuse(fmt::format("the arguments of '{}' are not as the protocol says", command));
  } catch (const std::exception&) {
    refuse(fmt::format("'{}' failed", command));
  }
  if (command == "initialize") initialize_ = message;
  if (attached_) {  // the run answers
    queue_.push_front(message);
    return queue_.push_front(initialize_);
  }
  if (who_.asks() && later_.is_null()) {
    later_ = std::move(answer);
    return go();
  }
  answer["seq"] = ++seq_;
  const bool good = answer["success"].get<bool>();
  send_(answer);
  if (command == "initialize" && good) event("initialized", Json::object());
  if (command == "terminate" && good) event("terminated", Json::object());
  if (only_looks() && good) tell_looks(command);
  if (const auto task = std::exchange(later_stop_, std::nullopt)) tell_stop("goto", "", {}, *task);
  if (order_) go();
}

void DapServer::event(const std::string& name, Json body) {
  send_({{"type", "event"}, {"seq", ++seq_}, {"event", name}, {"body", std::move(body)}});
}

void DapServer::output(const std::string& text) {
  event("output", {{"category", "console"}, {"output", text}});
}

// After run() this may be another process: only members are used.
void DapServer::go() {
  const Order order = *order_;
  order_.reset();
  began_ = std::chrono::steady_clock::now();
  frames_.listen(!order.backward);
  carry_on(debugger_->run(order));
}

// Who has changed a value is looked for without a stop: behind the way back and the way forth stands the answer.
void DapServer::carry_on(Stop stop) {
  while (who_.asks()) {
    if (const auto answer = who_.answer(*debugger_, stop)) {
      Json response = std::exchange(later_, nullptr);
      response["seq"] = ++seq_;
      if (response["command"] == "dataBreakpointInfo")
        response["body"]["description"] = fmt::format("{} ({})", response["body"]["description"].get<std::string>(), *answer);
      else
        response["body"] = {{"result", *answer}, {"variablesReference", 0}};
      return send_(response);
    }
    stop = debugger_->return_to(who_.from());
  }
  cost_.stopped(*debugger_);
  report(stop);
}

void DapServer::tell_journal() {
  const auto& entries = debugger_->plant().journal().entries();
  for (; told_ < entries.size(); ++told_)
    if (entries[told_].weight != runtime::Weight::Why)
      event("output",
            {{"category", "stderr"},
             {"output", fmt::format("{:.3f} ms {}: {}\n", static_cast<double>(entries[told_].time) / 1e6,
                                    entries[told_].station, entries[told_].text)}});
}

void DapServer::report(const Stop& stop) {
  tell_journal();
  static constexpr const char* kReasons[] = {"entry",     "breakpoint", "data breakpoint", "step",  "pause",
                                             "exception", "step",       "pause",           "pause", "step"};
  std::string reason = kReasons[static_cast<size_t>(stop.reason)], text = stop.text;
  std::vector<int> ids = stop.ids;
  const auto is_fault = [this](int id) {
    return std::find(fault_points_.begin(), fault_points_.end(), id) != fault_points_.end();
  };
  if (std::any_of(ids.begin(), ids.end(), is_fault)) reason = "exception";
  if (stop.reason == Reason::Pause && frames_.has_seen()) {
    reason = "function breakpoint";
    text = frames_.text();
    ids.push_back(frames_.id());
  }
  fault_ = reason == "exception" ? text : "";
  tell_stop(reason, text, ids, stop.task);
}

void DapServer::tell_stop(const std::string& reason, const std::string& text, const std::vector<int>& ids, TaskRef task) {
  references_.clear();
  targets_.clear();
  // Virtual time, which no editor has a place for.
  const std::string time = fmt::format("{:.3f} ms", static_cast<double>(debugger_->plant().now()) / 1e6);
  Json body{{"reason", reason},
            {"allThreadsStopped", true},
            {"text", text},
            {"description", fmt::format("{} at {}{}", text.empty() ? reason : text, time,
                                        cost_.commands() == 0 ? "" : fmt::format(", {} commands later", cost_.commands()))},
            {"hitBreakpointIds", ids}};
  const std::vector<TaskRef> tasks = debugger_->tasks();
  if (task.task == 0 && !tasks.empty()) task = tasks.front();
  if (task.task != 0) body["threadId"] = static_cast<int>(task.station) * kTaskNumbers + task.task + 1;
  event("stopped", std::move(body));
}

bool DapServer::keep_going() {
  poll();
  // What an editor does while the plant runs takes effect at once; everything else waits for a stop.
  static constexpr std::string_view kAlways[] = {"setBreakpoints", "setInstructionBreakpoints",
                                                 "setFunctionBreakpoints", "threads"};
  const auto at_once = [](const Json& message) {
    return std::find(std::begin(kAlways), std::end(kAlways), command_of(message)) != std::end(kAlways);
  };
  for (;;) {
    const auto order = std::find_if(queue_.begin(), queue_.end(), gives_order);  // behind it is behind this run
    const auto next = std::find_if(queue_.begin(), order, at_once);
    if (next == order) break;
    const Json message = std::move(*next);
    queue_.erase(next);
    answer(message);
  }
  return !frames_.has_seen() && !stop_is_asked();
}

// What ends this run, the end of the input at last, stands in the queue in front of the next order; what stands after one is meant for that. If this
// run does not come to an end by itself, it ends for that, too: nothing the editor has sent waits for ever.
bool DapServer::stop_is_asked() const {
  const auto stop = std::find_if(queue_.begin(), queue_.end(), stops_running);
  if (stop == queue_.end() && !closed_) return false;
  return std::none_of(queue_.begin(), stop, gives_order) ||
         std::chrono::steady_clock::now() - began_ > kLongestWait;
}

Json DapServer::save() {
  Json sources = Json::array();
  for (const auto& [id, source] : sources_) sources.push_back({id, source.first, source.second});
  return {{"seq", seq_},        {"told", told_},         {"queue", queue_}, {"faults", fault_points_},
          {"sources", sources}, {"input", save_input()}, {"frames", frames_.save()},
          {"functions", function_points_}, {"closed", closed_}, {"fault", fault_},
          {"cost", cost_.save()}, {"who", who_.save()}, {"later", later_},
          {"references", references_}, {"targets", targets_}};
}

void DapServer::load(const Json& state) {
  seq_ = state["seq"];
  told_ = state["told"];
  queue_ = state["queue"].get<std::deque<Json>>();
  began_ = std::chrono::steady_clock::now();
  closed_ = state["closed"];
  function_points_ = state["functions"].get<std::vector<int>>();
  fault_points_ = state["faults"].get<std::vector<int>>();
  frames_.load(state["frames"]);
  fault_ = state["fault"].get<std::string>();
  cost_.load(state["cost"]);
  who_.load(state["who"]);
  later_ = state["later"];
  references_ = state["references"].get<std::vector<Reference>>();
  targets_ = state["targets"].get<std::map<int64_t, std::pair<uint32_t, uint32_t>>>();
  order_.reset();
  sources_.clear();
  for (const Json& source : state["sources"])
    sources_[source[0].get<int>()] = {source[1].get<std::string>(), source[2].get<uint32_t>()};
  load_input(state["input"]);
}

Debugger& DapServer::debugger() {
  if (!debugger_) throw ValueError("nothing is launched");
  return *debugger_;
}

TaskRef DapServer::task_of(const Json& arguments, const char* key) const {
  const int number = arguments.at(key).get<int>() - 1;
  const TaskRef task{static_cast<uint32_t>(number / kTaskNumbers), number % kTaskNumbers};
  if (!debugger_ || number < 0 || task.task == 0 || task.station >= debugger_->plant().stations().size() ||
      debugger_->code(task.station) == nullptr)
    throw ValueError("there is no such thread");
  return task;
}

Json DapServer::initialize(const Json& arguments) {
  lines_from_1_ = arguments.value("linesStartAt1", true);
  columns_from_1_ = arguments.value("columnsStartAt1", true);
  uris_ = arguments.value("pathFormat", "path") == "uri";
  refreshes_ = arguments.value("supportsInvalidatedEvent", false);
  Json can = Json::object();
  for (const char* word :
       {"supportsConfigurationDoneRequest", "supportsFunctionBreakpoints", "supportsConditionalBreakpoints",
        "supportsHitConditionalBreakpoints", "supportsLogPoints", "supportsEvaluateForHovers",
        "supportsStepBack", "supportsSetVariable", "supportsSetExpression", "supportsDataBreakpoints",
        "supportsDisassembleRequest", "supportsInstructionBreakpoints", "supportsSteppingGranularity",
        "supportsTerminateRequest", "supportsRestartRequest", "supportsCompletionsRequest",
        "supportsValueFormattingOptions", "supportsBreakpointLocationsRequest", "supportsExceptionInfoRequest",
        "supportsReadMemoryRequest", "supportsGotoTargetsRequest", "supportsLoadedSourcesRequest"})
    can[word] = true;
  can["exceptionBreakpointFilters"] =
      Json::array({{{"filter", "fault"}, {"label", "Faults of drives"}, {"default", true}}});
  return can;
}

Json DapServer::launch(const Json& arguments) {
  if (debugger_) throw ValueError("there is a session already");
  const std::string plant = arguments.value("plant", ""), program = arguments.value("program", "");
  if (plant.empty() == program.empty()) throw ValueError("launch needs either a program or a plant");
  DapLaunch launch{plant.empty() ? program : plant, arguments.value("unit", ""), arguments.value("case", "")};
  stop_on_entry_ = arguments.value("stopOnEntry", true);
  debugger_.emplace(make_(launch), *this, std::move(snapshots_), runtime::kNever);
  cost_.begin(*debugger_);
  for (const ObjectFinding& one : object_findings(debugger_->plant())) {
    Json body{{"category", "stderr"}, {"output", text_of(one) + "\n"}};
    if (!one.place.file.empty()) {
      body["source"] = source_for_client(one.place.file);
      body["line"] = line_for_client(one.place.line);
      body["column"] = column_for_client(one.place.column);
    }
    event("output", std::move(body));
  }
  return Json::object();
}

Json DapServer::configured(const Json&) {
  debugger();
  if (only_looks()) return Json::object();
  if (stop_on_entry_)
    report({Reason::Entry, {}, {}, {}});
  else
    order_ = Order{};
  return Json::object();
}

Json DapServer::restart(const Json&) {
  debugger().restart();
  cost_.begin(*debugger_);
  told_ = 0;
  if (stop_on_entry_)
    report({Reason::Entry, {}, {}, {}});
  else
    order_ = Order{};
  return Json::object();
}

void DapServer::order(Motion line, Motion instruction, bool backward, const Json& arguments) {
  const bool by_instruction = arguments.value("granularity", "") == "instruction";
  order_ =
      debugger().order_for(by_instruction ? instruction : line, task_of(arguments, "threadId"), backward);
}

Json DapServer::resume(const Json&) {
  debugger();
  order_ = Order{};
  return {{"allThreadsContinued", true}};
}
Json DapServer::next(const Json& arguments) {
  order(Motion::Over, Motion::InstructionOver, false, arguments);
  return Json::object();
}
Json DapServer::step_in(const Json& arguments) {
  order(Motion::Into, Motion::Instruction, false, arguments);
  return Json::object();
}
Json DapServer::step_out(const Json& arguments) {
  order(Motion::Out, Motion::Out, false, arguments);
  return Json::object();
}
Json DapServer::step_back(const Json& arguments) {
  order(Motion::Over, Motion::Instruction, true, arguments);
  return Json::object();
}
Json DapServer::reverse_continue(const Json&) {
  debugger();
  order_ = Order{};
  order_->backward = true;
  return Json::object();
}

// A plant that runs has stopped by the time this is handled; one that stands has nothing to pause.
Json DapServer::pause(const Json&) { return Json::object(); }

// The plant is gone; the session ends by `disconnect` or the end of the input.
Json DapServer::terminate(const Json&) {
  debugger_.reset();
  return Json::object();
}

Json DapServer::disconnect(const Json&) {
  ended_ = true;
  return Json::object();
}

Json DapServer::threads(const Json&) {
  Json all = Json::array();
  for (const TaskRef task : debugger().tasks())
    all.push_back({{"id", static_cast<int>(task.station) * kTaskNumbers + task.task + 1},
                   {"name", debugger_->task_name(task)}});
  return {{"threads", all}};
}

}  // namespace ipos::tools::debug
