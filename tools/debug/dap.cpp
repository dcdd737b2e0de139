// Requests of the debug adapter protocol: the session, breakpoints, running.
#include "tools/debug/dap.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/station_signals.hpp"

namespace ipos::tools::debug {
namespace {

constexpr int kTaskNumbers = 4;  // thread = station x this + task + 1, as 0 is none

}  // namespace

struct DapServer::Request {
  std::string_view command;
  Handler handle;
};

const std::vector<DapServer::Request>& DapServer::requests() {
  using S = DapServer;
  static const std::vector<Request> kRequests = {
      {"initialize", &S::initialize},
      {"launch", &S::launch},
      {"configurationDone", &S::configured},
      {"setBreakpoints", &S::set_breakpoints},
      {"setInstructionBreakpoints", &S::set_instruction_breakpoints},
      {"dataBreakpointInfo", &S::data_breakpoint_info},
      {"setDataBreakpoints", &S::set_data_breakpoints},
      {"setExceptionBreakpoints", &S::set_exception_breakpoints},
      {"setFunctionBreakpoints", &S::set_function_breakpoints},
      {"threads", &S::threads},
      {"stackTrace", &S::stack_trace},
      {"scopes", &S::scopes},
      {"variables", &S::variables},
      {"setVariable", &S::set_variable},
      {"setExpression", &S::set_expression},
      {"evaluate", &S::evaluate_text},
      {"completions", &S::completions},
      {"restart", &S::restart},
      {"disassemble", &S::disassemble},
      {"continue", &S::resume},
      {"next", &S::next},
      {"stepIn", &S::step_in},
      {"stepOut", &S::step_out},
      {"stepBack", &S::step_back},
      {"reverseContinue", &S::reverse_continue},
      {"pause", &S::pause},
      {"disconnect", &S::disconnect},
      {"terminate", &S::disconnect},
  };
  return kRequests;
}

void DapServer::receive(std::string_view body) {
  Json message = Json::parse(body, nullptr, false);
  if (!message.is_object()) return;
  const std::string command = message.value("command", "");
  if (command == "pause" || command == "disconnect" || command == "terminate") pause_ = true;
  queue_.push_back(std::move(message));
}

bool DapServer::handle_next() {
  if (queue_.empty()) return false;
  const Json message = std::move(queue_.front());
  queue_.pop_front();
  Json answer{{"type", "response"}, {"request_seq", message.value("seq", int64_t{0})}, {"success", true}};
  const std::string command = message.contains("command") && message["command"].is_string()
                                  ? message["command"].get<std::string>()
                                  : std::string();
  answer["command"] = command;
  try {
    const Request* found = nullptr;
    for (const Request& request : requests())
      if (request.command == command) found = &request;
    if (found == nullptr) throw ValueError(fmt::format("'{}' is not known", command));
    const Json arguments = message.value("arguments", Json::object());
    answer["body"] = (this->*found->handle)(arguments);
  } catch (const std::exception& error) {
    answer["success"] = false;
    answer["message"] = error.what()[0] == '\0' ? "see the messages of ipos" : error.what();
  }
  answer["seq"] = ++seq_;
  send_(answer);
  if (command == "initialize" && answer["success"].get<bool>()) event("initialized", Json::object());
  if (order_) go();
  return true;
}

void DapServer::event(const std::string& name, Json body) {
  send_({{"type", "event"}, {"seq", ++seq_}, {"event", name}, {"body", std::move(body)}});
}

void DapServer::output(const std::string& text) {
  event("output", {{"category", "console"}, {"output", text}});
}

// Behind run() this may be another process: only members are used.
void DapServer::go() {
  const Order order = *order_;
  order_.reset();
  pause_ = false;
  forward_ = !order.backward;
  frame_seen_.clear();
  report(debugger_->run(order));
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
  references_.clear();
  tell_journal();
  static constexpr const char* kReasons[] = {"entry",     "breakpoint", "data breakpoint", "step",  "pause",
                                             "exception", "step",       "pause",           "pause", "step"};
  std::string reason = kReasons[static_cast<size_t>(stop.reason)], text = stop.text;
  std::vector<int> ids = stop.ids;
  const auto is_fault = [this](int id) {
    return std::find(fault_points_.begin(), fault_points_.end(), id) != fault_points_.end();
  };
  if (std::any_of(ids.begin(), ids.end(), is_fault)) reason = "exception";
  if (stop.reason == Reason::Pause && !frame_seen_.empty()) {
    reason = "function breakpoint";
    text = frame_seen_;
    ids.push_back(frame_id_);
  }
  // Virtual time, which no editor has a place for.
  const std::string time = fmt::format("{:.3f} ms", static_cast<double>(debugger_->plant().now()) / 1e6);
  Json body{{"reason", reason},
            {"allThreadsStopped", true},
            {"text", text},
            {"description", fmt::format("{} at {}", text.empty() ? reason : text, time)},
            {"hitBreakpointIds", ids}};
  TaskRef task = stop.task;
  const std::vector<TaskRef> tasks = debugger_->tasks();
  if (task.task == 0 && !tasks.empty()) task = tasks.front();
  if (task.task != 0) body["threadId"] = static_cast<int>(task.station) * kTaskNumbers + task.task + 1;
  event("stopped", std::move(body));
}

bool DapServer::keep_going() {
  poll();
  // What an editor does while the plant runs takes effect at once; everything else waits for a stop.
  static constexpr std::string_view kAlways[] = {"setBreakpoints", "setInstructionBreakpoints", "threads"};
  while (!queue_.empty() && std::find(std::begin(kAlways), std::end(kAlways),
                                      queue_.front().value("command", "")) != std::end(kAlways))
    handle_next();
  return !pause_ && frame_seen_.empty();
}

void DapServer::built(runtime::Plant& plant) {
  for (const auto& bus : plant.buses()) bus->add_observer(*this);
}

// What comes while time goes back has been seen before.
void DapServer::on_message(const runtime::Bus& bus, const runtime::BusMessage& message) {
  if (!forward_ || !frame_seen_.empty()) return;
  for (const auto& [id, pattern] : frame_points_)
    if (runtime::matches(pattern, message.text) ||
        runtime::matches(pattern, bus.name() + " " + message.text)) {
      frame_id_ = id;
      frame_seen_ = fmt::format("{} on {}", message.text, bus.name());
    }
}

Json DapServer::save() {
  Json sources = Json::array();
  for (const auto& [id, source] : sources_) sources.push_back({id, source.first, source.second});
  return {{"seq", seq_},        {"told", told_},         {"queue", queue_}, {"faults", fault_points_},
          {"sources", sources}, {"input", save_input()}, {"pause", pause_}, {"frames", frame_points_}};
}

void DapServer::load(const Json& state) {
  seq_ = state["seq"];
  told_ = state["told"];
  queue_ = state["queue"].get<std::deque<Json>>();
  pause_ = state["pause"];
  fault_points_ = state["faults"].get<std::vector<int>>();
  frame_points_ = state["frames"].get<std::vector<std::pair<int, std::string>>>();
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

Json DapServer::initialize(const Json&) {
  Json can = Json::object();
  for (const char* word :
       {"supportsConfigurationDoneRequest", "supportsFunctionBreakpoints", "supportsConditionalBreakpoints",
        "supportsHitConditionalBreakpoints", "supportsLogPoints", "supportsEvaluateForHovers",
        "supportsStepBack", "supportsSetVariable", "supportsSetExpression", "supportsDataBreakpoints",
        "supportsDisassembleRequest", "supportsInstructionBreakpoints", "supportsSteppingGranularity",
        "supportsTerminateRequest", "supportsRestartRequest", "supportsCompletionsRequest"})
    can[word] = true;
  can["exceptionBreakpointFilters"] =
      Json::array({{{"filter", "fault"}, {"label", "Faults of drives"}, {"default", true}}});
  return can;
}

Json DapServer::launch(const Json& arguments) {
  if (debugger_) throw ValueError("there is a session already");
  const std::string plant = arguments.value("plant", ""), program = arguments.value("program", "");
  if (plant.empty() == program.empty()) throw ValueError("launch needs either a program or a plant");
  DapLaunch launch{plant.empty() ? program : plant, arguments.value("unit", "")};
  stop_on_entry_ = arguments.value("stopOnEntry", true);
  debugger_.emplace(make_(launch), *this, snapshots_, runtime::kNever);
  return Json::object();
}

Json DapServer::configured(const Json&) {
  debugger();
  if (stop_on_entry_)
    report({Reason::Entry, {}, {}, {}});
  else
    order_ = Order{};
  return Json::object();
}

Json DapServer::breakpoint_json(const Breakpoint& breakpoint) const {
  const SourcePlace place = debugger_->code(breakpoint.station)->place(breakpoint.address);
  Json json{{"id", breakpoint.id},
            {"verified", true},
            {"instructionReference", fmt::format("{}", breakpoint.station * 65536 + breakpoint.address)}};
  if (place.line != 0) json["line"] = place.line;
  return json;
}

Json DapServer::set_breakpoints(const Json& arguments) {
  auto& all = debugger().breakpoints();
  const std::string file = arguments.at("source").value("path", arguments.at("source").value("name", ""));
  std::erase_if(all, [&](const Breakpoint& point) {
    const auto source = sources_.find(point.id);
    return source != sources_.end() && source->second.first == file;
  });
  Json answer = Json::array();
  for (const Json& asked : arguments.value("breakpoints", Json::array())) {
    const auto line = asked.at("line").get<uint32_t>();
    Json shown;
    // A source that several stations run stops each of them; the editor hears of one.
    for (uint32_t station = 0; station < debugger_->plant().stations().size(); ++station) {
      const CodeMap* code = debugger_->code(station);
      const auto address = code == nullptr ? std::nullopt : code->address_of(file, line);
      if (!address) continue;
      Breakpoint made{debugger_->next_id(),
                      station,
                      *address,
                      asked.value("condition", ""),
                      asked.value("hitCondition", ""),
                      asked.value("logMessage", ""),
                      false,
                      true,
                      0};
      sources_[made.id] = {file, line};
      if (shown.is_null()) shown = breakpoint_json(made);
      all.push_back(std::move(made));
    }
    if (shown.is_null())
      shown = {{"verified", false}, {"line", line}, {"message", "no command belongs to this line"}};
    answer.push_back(std::move(shown));
  }
  return {{"breakpoints", answer}};
}

// References of commands are station x 65536 + word address.
Json DapServer::set_instruction_breakpoints(const Json& arguments) {
  auto& all = debugger().breakpoints();
  std::erase_if(all, [&](const Breakpoint& point) { return !sources_.contains(point.id); });
  Json answer = Json::array();
  for (const Json& asked : arguments.at("breakpoints")) {
    const auto number =
        static_cast<uint32_t>(std::stoul(asked.at("instructionReference").get<std::string>(), nullptr, 0)) +
        static_cast<uint32_t>(asked.value("offset", 0));
    const uint32_t station = number >> 16U, address = number & 0xFFFFU;
    if (station >= debugger_->plant().stations().size() || debugger_->code(station) == nullptr ||
        !debugger_->code(station)->is_command(address)) {
      answer.push_back({{"verified", false}, {"message", "no command begins there"}});
      continue;
    }
    all.push_back({debugger_->next_id(), station, address, asked.value("condition", ""),
                   asked.value("hitCondition", ""), "", false, true, 0});
    answer.push_back(breakpoint_json(all.back()));
  }
  return {{"breakpoints", answer}};
}

Json DapServer::data_breakpoint_info(const Json& arguments) {
  uint32_t station = 0;
  const auto reference = arguments.value("variablesReference", 0U);
  if (reference > 0 && reference <= references_.size()) station = references_[reference - 1].station;
  std::string name = arguments.at("name");
  if (reference > 0 && reference <= references_.size() && name.starts_with('['))
    name = references_[reference - 1].name + name;
  try {
    const ValuePlace place = evaluate_place(debugger().plant(), station, name);
    const std::string whole = debugger_->plant().stations()[place.station]->config().name + "." +
                              place.name.substr(place.station == station ? 0 : place.name.find('.') + 1);
    return {{"dataId", Json(place).dump()},
            {"description", whole},
            {"accessTypes", Json::array({"write"})},
            {"canPersist", false}};
  } catch (const ValueError& error) {
    return {{"dataId", nullptr}, {"description", error.what()}};
  }
}

Json DapServer::set_data_breakpoints(const Json& arguments) {
  std::erase_if(debugger().watchpoints(), [this](const Watchpoint& point) {
    return std::find(fault_points_.begin(), fault_points_.end(), point.id) == fault_points_.end();
  });
  Json answer = Json::array();
  for (const Json& asked : arguments.at("breakpoints")) {
    ValuePlace place = Json::parse(asked.at("dataId").get<std::string>());
    if (place.station >= debugger_->plant().stations().size() ||
        !find_value(debugger_->plant(), place.station, place.name.substr(0, place.name.find('['))))
      throw ValueError("the data id is none of this session");
    debugger_->watchpoints().push_back(
        {debugger_->next_id(), place.station, place, asked.value("condition", ""), true, 0});
    answer.push_back({{"id", debugger_->watchpoints().back().id}, {"verified", true}});
  }
  return {{"breakpoints", answer}};
}

// A program that faults stops anyway.
Json DapServer::set_exception_breakpoints(const Json& arguments) {
  auto& all = debugger().watchpoints();
  std::erase_if(all, [this](const Watchpoint& point) {
    return std::find(fault_points_.begin(), fault_points_.end(), point.id) != fault_points_.end();
  });
  fault_points_.clear();
  const Json filters = arguments.value("filters", Json::array());
  if (std::find(filters.begin(), filters.end(), "fault") == filters.end()) return Json::object();
  const auto& stations = debugger_->plant().stations();
  for (uint32_t n = 0; n < stations.size(); ++n) {
    const std::string name = stations[n]->config().name + ".fault";
    all.push_back({debugger_->next_id(), n, {n, ValueKind::Fault, 0, 1, name}, name, true, 0});
    fault_points_.push_back(all.back().id);
  }
  return Json::object();
}

// Functions are lines already; here a name is a frame: "40A#80*", "sbus1 40A#*", or the bytes of a telegram.
Json DapServer::set_function_breakpoints(const Json& arguments) {
  frame_points_.clear();
  Json answer = Json::array();
  for (const Json& asked : arguments.value("breakpoints", Json::array())) {
    frame_points_.emplace_back(debugger().next_id(), asked.at("name").get<std::string>());
    answer.push_back({{"id", frame_points_.back().first}, {"verified", true}});
  }
  return {{"breakpoints", answer}};
}

Json DapServer::restart(const Json&) {
  debugger().restart();
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
