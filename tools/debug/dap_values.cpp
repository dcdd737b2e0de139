// Requests of the debug adapter protocol: the values of a plant that stands still.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "runtime/signals/find.hpp"
#include "tools/debug/dap.hpp"

namespace ipos::tools::debug {
namespace {

// Scopes of a station, and Elements of an array within one.
enum Scope : int { Named, Numbers, Parameters, Io, ProcessData, SbusObjects, Elements };
constexpr const char* kScopes[] = {"Variables",    "H",           "Parameters", "Inputs and outputs",
                                   "Process data", "SBus objects"};

constexpr int64_t kMostBytes = 65'536;  // of one request

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t n = 0; n < bytes.size(); n += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k) three = three << 8U | (n + k < bytes.size() ? bytes[n + k] : 0U);
    for (size_t k = 0; k < 4; ++k) text += n + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

bool wants_hex(const Json& arguments) {
  const auto format = arguments.find("format");
  return format != arguments.end() && format->is_object() && format->value("hex", false);
}

}  // namespace

uint32_t DapServer::reference(uint32_t station, int scope, uint32_t first, uint32_t count, std::string name) {
  references_.push_back({station, scope, first, count, std::move(name)});
  return static_cast<uint32_t>(references_.size());
}

Json DapServer::scopes(const Json& arguments) {
  const Json thread{{"id", arguments.at("frameId").get<int>() / kFramesOfTask}};
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

Json DapServer::value_json(const ValuePlace& place, bool hex) const {
  Json json{{"name", place.name},
            {"value", value_text(place, hex)},
            {"evaluateName", place.name},
            {"variablesReference", 0}};
  if (place.signal->is_variable()) json["memoryReference"] = fmt::format("{}:H{}", place.station, place.signal->number);
  return json;
}

// The H variables of a station from "0:H420" on, four bytes each, the lowest one first.
Json DapServer::read_memory(const Json& arguments) {
  const auto reference = arguments.at("memoryReference").get<std::string>();
  size_t station = 0, first = 0;
  int length = 0;
  if (std::sscanf(reference.c_str(), "%zu:H%zu%n", &station, &first, &length) != 2 || static_cast<size_t>(length) != reference.size() ||
      station >= debugger().plant().stations().size() || first >= debugger_->plant().stations()[station]->config().unit->variables)
    throw ValueError("there is no memory of this name");
  const runtime::Station& unit = *debugger_->plant().stations()[station];
  const int64_t end = int64_t{4} * unit.config().unit->variables;
  const int64_t begin = int64_t{4} * static_cast<int64_t>(first) + std::clamp<int64_t>(arguments.value("offset", int64_t{0}), -end, end);
  const int64_t count = std::clamp<int64_t>(arguments.at("count").get<int64_t>(), 0, kMostBytes);
  std::vector<uint8_t> bytes;
  int64_t at = std::clamp<int64_t>(begin, 0, end);
  if (at == begin)
    for (; at < std::min(begin + count, end); ++at)
      bytes.push_back(static_cast<uint8_t>(static_cast<uint32_t>(unit.variable(static_cast<uint32_t>(at / 4))) >> (at % 4 * 8)));
  return {{"address", fmt::format("{}", at)}, {"data", base64(bytes)}, {"unreadableBytes", count - static_cast<int64_t>(bytes.size())}};
}

Json DapServer::scope_values(uint32_t station, int scope, bool hex) const {
  Json all = Json::array();
  const runtime::Plant& plant = debugger_->plant();
  runtime::Station& unit = *plant.stations()[station];
  const auto text = [&](std::string name, std::string value) {
    all.push_back({{"name", std::move(name)}, {"value", std::move(value)}, {"variablesReference", 0}});
  };
  const auto group = [&](signals::Group of) {
    for (signals::Signal& signal : signals::signals_of(unit, of)) {
      const std::string name(signal.own_name());
      all.push_back(value_json({station, 1, name, std::make_shared<const signals::Signal>(std::move(signal))}, hex));
    }
  };
  if (scope == Parameters) {
    group(signals::Group::Parameter);
  } else if (scope == Io) {
    group(signals::Group::Input);
    group(signals::Group::Output);
  } else if (scope == ProcessData) {
    for (const signals::Signal& signal : signals::signals_of(unit, signals::Group::ProcessData))
      if (signal.bits != 0) text(std::string(signal.own_name()), fmt::format("{:#06x}", signal.read()));
    text("status word 1", fmt::format("{:#06x}", unit.status_word_1()));
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

// After the prefix, "", "left." or "all[": what has more parts is a structure, and stands there once.
Json DapServer::named_values(uint32_t station, const std::string& prefix, bool hex) {
  Json all = Json::array();
  std::vector<std::string> structures;
  for (const vm::Symbol& symbol : debugger_->plant().stations()[station]->symbols()) {
    if (!symbol.name.starts_with(prefix)) continue;
    const std::string rest = symbol.name.substr(prefix.size());
    if (const size_t dot = rest.find('.'); dot != std::string::npos) {
      const std::string name = rest.substr(0, dot);
      if (std::find(structures.begin(), structures.end(), name) != structures.end()) continue;
      structures.push_back(name);
      all.push_back({{"name", prefix.ends_with('[') ? "[" + name : name},
                     {"value", "{...}"},
                     {"evaluateName", prefix + name},
                     {"variablesReference", reference(station, Named, 0, 0, prefix + name + ".")}});
      continue;
    }
    Json one = value_json(*variable_place(debugger_->plant(), station, symbol.variable, symbol.name), hex);
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

// Elements of an array and numbers are the indexed children, all others named ones.
Json DapServer::variables(const Json& arguments) {
  const auto number = arguments.at("variablesReference").get<size_t>();
  if (number == 0 || number > references_.size()) throw ValueError("there is no such reference");
  const Reference asked = references_[number - 1];
  const runtime::Station& station = *debugger().plant().stations()[asked.station];
  const bool hex = wants_hex(arguments);
  const bool indexed = asked.scope == Numbers || asked.scope == Elements;
  const std::string filter = arguments.value("filter", "");
  Json all = Json::array();
  if ((filter == "named" && indexed) || (filter == "indexed" && !indexed)) return {{"variables", all}};
  if (asked.scope == Named) {
    all = named_values(asked.station, asked.name, hex);
  } else if (indexed) {
    const uint32_t most = asked.scope == Numbers ? station.config().unit->variables : asked.count;
    const uint32_t from = std::min(arguments.value("start", 0U), most);
    const uint32_t asked_count = arguments.value("count", 0U);
    const uint32_t end = asked_count == 0 ? most : std::min(most - from, asked_count) + from;
    for (uint32_t n = from; n < end; ++n) {
      Json one = value_json(*variable_place(debugger_->plant(), asked.station, asked.first + n,
                                            asked.scope == Numbers ? fmt::format("H{}", n) : fmt::format("[{}]", n)),
                            hex);
      if (asked.scope == Elements) one["evaluateName"] = fmt::format("{}[{}]", asked.name, n);
      all.push_back(std::move(one));
    }
  } else {
    all = scope_values(asked.station, asked.scope, hex);
  }
  return {{"variables", all}};
}

Json DapServer::set_value(const ValuePlace& place, uint32_t station, const Json& arguments) {
  debugger().write(place, evaluate_for(debugger_->plant(), station, place,
                                       arguments.at("value").get<std::string>()));
  return {{"value", value_text(place, wants_hex(arguments))}};
}

Json DapServer::set_variable(const Json& arguments) {
  const auto number = arguments.at("variablesReference").get<size_t>();
  if (number == 0 || number > references_.size()) throw ValueError("there is no such reference");
  const Reference within = references_[number - 1];
  const std::string name = arguments.at("name");
  const bool inside = within.scope == Elements || within.scope == Named;
  return set_value(evaluate_place(debugger().plant(), within.station, inside ? within.name + name : name),
                   within.station, arguments);
}

// The first station when no frame is given.
uint32_t DapServer::station_of_frame(const Json& arguments) {
  if (!arguments.contains("frameId")) return debugger(), 0;
  return task_of({{"id", arguments["frameId"].get<int>() / kFramesOfTask}}, "id").station;
}

Json DapServer::set_expression(const Json& arguments) {
  const uint32_t station = station_of_frame(arguments);
  return set_value(
      evaluate_place(debugger_->plant(), station, arguments.at("expression").get<std::string>()), station,
      arguments);
}

// "speed = 5" writes where the user types it; "speed,h" is hexadecimal.
Json DapServer::evaluate_text(const Json& arguments) {
  std::string text = arguments.at("expression");
  const uint32_t station = station_of_frame(arguments);
  bool hex = wants_hex(arguments);
  for (const std::string_view ending : {",h", ",x", ", h", ", x"})
    if (text.ends_with(ending)) {
      hex = true;
      text.resize(text.size() - ending.size());
      break;
    }
  if (const auto answer = console_word(text, arguments)) return *answer;
  const size_t at = text.find('=');
  const bool writes = arguments.value("context", "") == "repl" && at != std::string::npos && at != 0 &&
                      at + 1 < text.size() && text[at + 1] != '=' &&
                      std::string_view("=!<>").find(text[at - 1]) == std::string_view::npos;
  std::string name = writes ? text.substr(0, at) : text;
  name.erase(0, name.find_first_not_of(" \t"));
  name.erase(name.find_last_not_of(" \t") + 1);
  const runtime::Plant& plant = debugger_->plant();
  if (writes) {
    const ValuePlace place = evaluate_place(plant, station, name);
    debugger_->write(place, evaluate_for(plant, station, place, text.substr(at + 1)));
  }
  if (const auto whole = find_whole(plant, station, name)) return whole_json(*whole, hex);
  if (const auto place = find_value(plant, station, name))
    return {{"result", value_text(*place, hex)}, {"variablesReference", 0}};
  return {{"result", number_text(evaluate(plant, station, name), hex)}, {"variablesReference", 0}};
}

// Words of `ipos debug` that an editor has no request for; in the console, two words are never an expression.
std::optional<Json> DapServer::console_word(const std::string& text, const Json& arguments) {
  if (arguments.value("context", "") != "repl") return std::nullopt;
  const auto told = [](std::string result) {
    while (result.ends_with('\n')) result.pop_back();
    return Json{{"result", result}, {"variablesReference", 0}};
  };
  if (only_looks()) return std::nullopt;
  if (text == "info cost") return told(cost_.text(*debugger_));
  if (!text.starts_with("who ")) return std::nullopt;
  TaskRef task;
  if (arguments.contains("frameId")) task = task_of({{"id", arguments["frameId"].get<int>() / kFramesOfTask}}, "id");
  order_ = who_.ask(*debugger_, task, evaluate_place(debugger_->plant(), station_of_frame(arguments), text.substr(4)));
  return Json::object();  // carry_on() answers
}

// A structure opens to its members, an array to its elements.
Json DapServer::whole_json(const Whole& whole, bool hex) {
  Json json{{"result", whole_text(debugger_->plant(), whole, hex)}};
  std::string prefix = whole.name + "[";  // of an array of structures
  for (const vm::Symbol& symbol : debugger_->plant().stations()[whole.station]->image()->symbols) {
    if (symbol.name == whole.name) {
      json["variablesReference"] = reference(whole.station, Elements, symbol.variable, symbol.count, symbol.name);
      json["indexedVariables"] = symbol.count;
      return json;
    }
    if (symbol.name.starts_with(whole.name + ".")) prefix = whole.name + ".";
  }
  json["variablesReference"] = reference(whole.station, Named, 0, 0, prefix);
  return json;
}

// What the word in front of the cursor begins: variables and signals of the station.
Json DapServer::completions(const Json& arguments) {
  const uint32_t station = station_of_frame(arguments);
  const std::string text = arguments.at("text");
  const int64_t asked = arguments.at("column").get<int64_t>() - (columns_from_1_ ? 1 : 0);
  const auto column = static_cast<size_t>(std::clamp<int64_t>(asked, 0, static_cast<int64_t>(text.size())));
  size_t begin = column;
  while (begin > 0 && std::string_view(" +-*/%&|^!<>=(,").find(text[begin - 1]) == std::string_view::npos)
    --begin;
  const std::string word = text.substr(begin, column - begin);
  const runtime::Station& unit = *debugger().plant().stations()[station];
  Json all = Json::array();
  for (const std::string_view known : {"who ", "info cost"})
    if (begin == 0 && !word.empty() && known.starts_with(word))
      all.push_back({{"label", known}, {"start", column_for_client(1)}, {"length", word.size()}, {"type", "keyword"}});
  for (const signals::Signal& signal : signals::station_signals(unit)) {
    const std::string name(signal.own_name());
    if (name.starts_with(word))
      all.push_back({{"label", name}, {"start", column_for_client(static_cast<uint32_t>(begin) + 1)}, {"length", word.size()}, {"type", "variable"}});
  }
  return {{"targets", std::move(all)}};
}

}  // namespace ipos::tools::debug
