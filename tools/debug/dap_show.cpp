// Requests of the debug adapter protocol: what a plant that stands still looks like.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/debug/dap.hpp"
#include "tools/input/sources.hpp"

namespace ipos::tools::debug {
namespace {

// Scopes of a station, and Elements of an array within one.
enum Scope : int { Named, Numbers, Parameters, Io, ProcessData, SbusObjects, Elements };
constexpr const char* kScopes[] = {"Variables",    "H",           "Parameters", "Inputs and outputs",
                                   "Process data", "SBus objects"};
constexpr int kFrames = 64;  // frame = thread x this + number

}  // namespace

uint32_t DapServer::reference(uint32_t station, int scope, uint32_t first, uint32_t count, std::string name) {
  references_.push_back({station, scope, first, count, std::move(name)});
  return static_cast<uint32_t>(references_.size());
}

Json DapServer::stack_trace(const Json& arguments) {
  const TaskRef task = task_of(arguments, "threadId");
  const std::vector<Frame> frames = debugger_->frames(task);
  const auto from = arguments.value("startFrame", size_t{0});
  const auto levels = arguments.value("levels", size_t{0});
  Json all = Json::array();
  for (size_t n = from; n < frames.size() && (levels == 0 || n < from + levels); ++n) {
    const Frame& frame = frames[n];
    Json one{{"id", arguments.at("threadId").get<int>() * kFrames + static_cast<int>(n)},
             {"name", frame.function.empty() ? fmt::format("word {}", frame.address) : frame.function},
             {"line", frame.place.line},
             {"column", frame.place.column},
             {"instructionPointerReference", fmt::format("{}", task.station * 65536 + frame.address)}};
    if (frame.place.line != 0) {
      std::error_code error;
      const auto path = std::filesystem::absolute(frame.place.file, error);
      one["source"] = {{"name", path.filename().string()}, {"path", path.string()}};
      if (source_has_changed(frame.place.file))
        one["source"]["origin"] = "changed since it was compiled: the lines are those of the text that runs";
    }
    all.push_back(std::move(one));
  }
  return {{"stackFrames", all}, {"totalFrames", frames.size()}};
}

Json DapServer::scopes(const Json& arguments) {
  const Json thread{{"id", arguments.at("frameId").get<int>() / kFrames}};
  const uint32_t station = task_of(thread, "id").station;
  Json all = Json::array();
  for (int scope = Named; scope < Elements; ++scope) {
    Json one{{"name", kScopes[scope]},
             {"variablesReference", reference(station, scope)},
             {"expensive", scope == Parameters}};
    if (scope == Numbers)
      one["indexedVariables"] = debugger_->plant().stations()[station]->config().unit->variables;
    all.push_back(std::move(one));
  }
  return {{"scopes", all}};
}

Json DapServer::value_json(const ValuePlace& place) const {
  return {{"name", place.name},
          {"value", value_text(debugger_->plant(), place, read_value(debugger_->plant(), place))},
          {"evaluateName", place.name},
          {"variablesReference", 0}};
}

Json DapServer::scope_values(uint32_t station, int scope) const {
  Json all = Json::array();
  const runtime::Plant& plant = debugger_->plant();
  runtime::Station& unit = *plant.stations()[station];
  const auto text = [&](std::string name, std::string value) {
    all.push_back({{"name", std::move(name)}, {"value", std::move(value)}, {"variablesReference", 0}});
  };
  if (scope == Parameters) {
    for (const stdlib::Parameter& row : stdlib::parameter_table(*unit.config().unit).rows())
      if (!row.number.empty() && row.index != 0)
        all.push_back(
            value_json({station, ValueKind::Parameter, row.index, 1, fmt::format("P{}", row.number)}));
  } else if (scope == Io) {
    for (uint32_t line = 0; line < runtime::kBinaryLines; ++line)
      all.push_back(
          value_json({station, ValueKind::Input, line, 1, fmt::format("DI{}{}", line / 8, line % 8)}));
    for (uint32_t bit = 0; bit < 16; ++bit)
      if (const std::string name = bit == 0 ? "DB00" : fmt::format("DO{}{}", bit / 8, bit % 8);
          runtime::parse_output(name) >= 0)
        all.push_back(value_json({station, ValueKind::Output, bit, 1, name}));
  } else if (scope == ProcessData) {
    const runtime::Drive& drive = unit.drive().state();
    const auto pi = drive.pi();
    for (size_t n = 0; n < runtime::kProcessWords; ++n) {
      text(fmt::format("PO{}", n + 1), fmt::format("{:#06x}", drive.po()[n]));
      text(fmt::format("PI{}", n + 1), fmt::format("{:#06x}", pi[n]));
    }
    for (size_t n = 0; unit.has_further_words() && n < runtime::kFurtherWords; ++n) {
      const size_t number = runtime::kProcessWords + n + 1;
      text(fmt::format("PO{}", number), fmt::format("{:#06x}", drive.further_po()[n]));
      text(fmt::format("PI{}", number), fmt::format("{:#06x}", drive.further_pi()[n]));
    }
    text("status word 1", fmt::format("{:#06x}", drive.status_word_1()));
  } else if (scope == SbusObjects) {
    for (const int number : {1, 2})
      if (const runtime::SbusPort* port = plant.stations()[station]->sbus(number))
        for (const runtime::ObjectDefinition& object : port->objects().definitions())
          text(fmt::format("SBus {} object {}", number, runtime::object_words(object.object)),
               fmt::format("{}, data H{}{}",
                           object.kind == runtime::ObjectKind::Receive ? "receive" : "transmit", object.data,
                           object.accepted ? "" : ", refused: " + object.why));
  }
  return all;
}

// Behind the prefix, "" or "left.": what has more parts is a structure, and stands there once.
Json DapServer::named_values(uint32_t station, const std::string& prefix) {
  Json all = Json::array();
  std::vector<std::string> structures;
  for (const vm::Symbol& symbol : debugger_->plant().stations()[station]->image()->symbols) {
    if (!symbol.name.starts_with(prefix)) continue;
    const std::string rest = symbol.name.substr(prefix.size());
    if (const size_t dot = rest.find('.'); dot != std::string::npos) {
      const std::string name = rest.substr(0, dot);
      if (std::find(structures.begin(), structures.end(), name) != structures.end()) continue;
      structures.push_back(name);
      all.push_back({{"name", name},
                     {"value", "{...}"},
                     {"variablesReference", reference(station, Named, 0, 0, prefix + name + ".")}});
      continue;
    }
    Json one = value_json({station, ValueKind::Variable, symbol.variable, 1, symbol.name});
    one["name"] = rest;
    if (symbol.count > 1) {
      one["value"] = fmt::format("{} elements", symbol.count);
      one["variablesReference"] = reference(station, Elements, symbol.variable, symbol.count, symbol.name);
      one["indexedVariables"] = symbol.count;
    }
    all.push_back(std::move(one));
  }
  return all;
}

Json DapServer::variables(const Json& arguments) {
  const auto number = arguments.at("variablesReference").get<size_t>();
  if (number == 0 || number > references_.size()) throw ValueError("there is no such reference");
  const Reference asked = references_[number - 1];
  const runtime::Station& station = *debugger().plant().stations()[asked.station];
  Json all = Json::array();
  if (asked.scope == Named && station.image() != nullptr) {
    all = named_values(asked.station, asked.name);
  } else if (asked.scope == Numbers || asked.scope == Elements) {
    const uint32_t most = asked.scope == Numbers ? station.config().unit->variables : asked.count;
    const uint32_t from = std::min(arguments.value("start", 0U), most);
    const uint32_t asked_count = arguments.value("count", 0U);
    const uint32_t end = asked_count == 0 ? most : std::min(most - from, asked_count) + from;
    for (uint32_t n = from; n < end; ++n) {
      Json one = value_json({asked.station, ValueKind::Variable, asked.first + n, 1,
                             asked.scope == Numbers ? fmt::format("H{}", n) : fmt::format("[{}]", n)});
      if (asked.scope == Elements) one["evaluateName"] = fmt::format("{}[{}]", asked.name, n);
      all.push_back(std::move(one));
    }
  } else {
    all = scope_values(asked.station, asked.scope);
  }
  return {{"variables", all}};
}

Json DapServer::set_variable(const Json& arguments) {
  const auto number = arguments.at("variablesReference").get<size_t>();
  if (number == 0 || number > references_.size()) throw ValueError("there is no such reference");
  const Reference& within = references_[number - 1];
  const std::string name = arguments.at("name");
  const bool inside = within.scope == Elements || within.scope == Named;
  const ValuePlace place =
      evaluate_place(debugger().plant(), within.station, inside ? within.name + name : name);
  debugger_->write(place,
                   evaluate(debugger_->plant(), within.station, arguments.at("value").get<std::string>()));
  return {{"value", value_text(debugger_->plant(), place, read_value(debugger_->plant(), place))}};
}

Json DapServer::set_expression(const Json& arguments) {
  const Json thread{{"id", arguments.value("frameId", 2 * kFrames) / kFrames}};
  const uint32_t station = task_of(thread, "id").station;
  const ValuePlace place =
      evaluate_place(debugger().plant(), station, arguments.at("expression").get<std::string>());
  debugger_->write(place, evaluate(debugger_->plant(), station, arguments.at("value").get<std::string>()));
  return {{"value", value_text(debugger_->plant(), place, read_value(debugger_->plant(), place))}};
}

// "speed = 5" writes where the user types it.
Json DapServer::evaluate_text(const Json& arguments) {
  const std::string text = arguments.at("expression");
  uint32_t station = 0;
  if (arguments.contains("frameId")) {
    const Json thread{{"id", arguments["frameId"].get<int>() / kFrames}};
    station = task_of(thread, "id").station;
  }
  const size_t at = text.find('=');
  const bool writes = arguments.value("context", "") == "repl" && at != std::string::npos && at != 0 &&
                      at + 1 < text.size() && text[at + 1] != '=' &&
                      std::string_view("=!<>").find(text[at - 1]) == std::string_view::npos;
  if (writes)
    debugger().write(evaluate_place(debugger_->plant(), station, text.substr(0, at)),
                     evaluate(debugger_->plant(), station, text.substr(at + 1)));
  const std::string name = writes ? text.substr(0, at) : text;
  if (const auto place = find_value(debugger().plant(), station, name))
    return {{"result", value_text(debugger_->plant(), *place, read_value(debugger_->plant(), *place))},
            {"variablesReference", 0}};
  return {{"result", fmt::format("{}", evaluate(debugger_->plant(), station, name))},
          {"variablesReference", 0}};
}

// What the word in front of the cursor begins: variables and signals of the station.
Json DapServer::completions(const Json& arguments) {
  uint32_t station = 0;
  if (arguments.contains("frameId"))
    station = task_of({{"id", arguments["frameId"].get<int>() / kFrames}}, "id").station;
  const std::string text = arguments.at("text");
  const size_t column = std::min(std::max(arguments.at("column").get<size_t>(), size_t{1}) - 1, text.size());
  size_t begin = column;
  while (begin > 0 && std::string_view(" +-*/%&|^!<>=(,").find(text[begin - 1]) == std::string_view::npos)
    --begin;
  const std::string word = text.substr(begin, column - begin);
  const runtime::Station& unit = *debugger().plant().stations()[station];
  Json all = Json::array();
  for (const runtime::PlantSignal& signal : runtime::station_signals(unit)) {
    const std::string name = signal.name.substr(unit.config().name.size() + 1);
    if (name.starts_with(word))
      all.push_back({{"label", name}, {"start", begin}, {"length", word.size()}, {"type", "variable"}});
  }
  return {{"targets", std::move(all)}};
}

Json DapServer::disassemble(const Json& arguments) {
  const auto number =
      static_cast<uint32_t>(std::stoul(arguments.at("memoryReference").get<std::string>(), nullptr, 0)) +
      static_cast<uint32_t>(arguments.value("offset", 0));
  const uint32_t station = number >> 16U;
  if (station >= debugger().plant().stations().size() || debugger_->code(station) == nullptr)
    throw ValueError("there is no program at this reference");
  const CodeMap& code = *debugger_->code(station);
  const auto count = std::min<int64_t>(arguments.at("instructionCount").get<int64_t>(), 10'000);
  const int64_t first =
      static_cast<int64_t>(code.item_at(number & 0xFFFFU)) + arguments.value("instructionOffset", int64_t{0});
  Json all = Json::array();
  for (int64_t n = first; n < first + count; ++n) {
    if (n < 0 ||
        n >= static_cast<int64_t>(code.items().size())) {  // the editor wants as many as it asked for
      all.push_back({{"address", fmt::format("{}", station * 65536 + 65535)},
                     {"instruction", "-"},
                     {"presentationHint", "invalid"}});
      continue;
    }
    const uint32_t address = code.items()[static_cast<size_t>(n)].address;
    Json one{{"address", fmt::format("{}", station * 65536 + address)}, {"instruction", code.text(address)}};
    if (const SourcePlace place = code.place(address); place.line != 0) {
      std::error_code error;
      one["line"] = place.line;
      one["location"] = {{"path", std::filesystem::absolute(place.file, error).string()}};
    }
    all.push_back(std::move(one));
  }
  return {{"instructions", all}};
}

}  // namespace ipos::tools::debug
