// One JSON object. Its first member is the format with its version; a text that is not UTF-8 stands in it byte by byte.
#include "tools/serve/host/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/plant/trace_hash.hpp"
#include "tools/serve/host/plant_host.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "ipos_session";
constexpr int kVersion = 1;

// Each byte as the character of its number.
std::string widened(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xC0 | byte >> 6U);
      text += static_cast<char>(0x80 | (byte & 0x3FU));
    }
  }
  return text;
}
std::string narrowed(const std::string& text) {
  std::string bytes;
  for (size_t n = 0; n < text.size(); ++n) {
    const auto first = static_cast<unsigned char>(text[n]);
    if (first < 0x80) {
      bytes += text[n];
      continue;
    }
    if ((first & 0xFCU) != 0xC0 || n + 1 == text.size()) throw Mistake("a text of bytes has another character");
    bytes += static_cast<char>((first & 0x03U) << 6U | (static_cast<unsigned char>(text[++n]) & 0x3FU));
  }
  return bytes;
}

bool is_utf8(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore) == Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

// What runs, where it is known, else what the file has.
std::optional<std::string> running_text(PlantHost& host, const std::string& file) {
  for (uint32_t n = 0; n < host.plant().stations().size(); ++n)
    if (auto text = host.texts().text(n, file)) return text;
  return host.files().text(file);
}

// A path that stays in the folder.
bool is_inside(const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  return !name.empty() && path.is_relative() && *path.begin() != ".." && name.find('\\') == std::string::npos;
}

}  // namespace

Session session_of(PlantHost& host, Json settings) {
  Session session;
  session.settings = std::move(settings);
  const auto files = host.files().list();
  const auto plant = std::find_if(files.begin(), files.end(), [](const Files::Entry& entry) {
    return entry.kind == Files::Kind::Plant;
  });
  const auto first = plant != files.end() ? plant : files.begin();
  if (first == files.end()) throw Mistake("no files belong to this plant; a session cannot hold it");
  const fs::path folder = fs::path(first->name).parent_path();
  for (const Files::Entry& entry : files) {
    if (entry.kind == Files::Kind::Test || entry.kind == Files::Kind::Session) continue;
    const std::string name = fs::path(entry.name).lexically_relative(folder.empty() ? "." : folder).generic_string();
    if (!is_inside(name))
      throw Mistake(fmt::format("{} lies outside of the folder of the plant; a session cannot hold it", entry.name));
    auto text = running_text(host, entry.name);
    if (!text) throw Mistake(fmt::format("{} cannot be read", entry.name));
    session.texts[name] = *std::move(text);
    if (entry.name == first->name) session.plant = name;
  }
  for (const runtime::StationConfig& station : host.plant().file().stations)
    if (!station.program.empty() && !session.texts.contains(fs::path(station.program).lexically_normal().generic_string()))
      throw Mistake(fmt::format("{} runs {}, which has no text; a session cannot hold it", station.name, station.program));
  session.moment = host.debugger().position();
  for (const debug::Change& change : host.debugger().changes()) {
    if (change.at > session.moment) continue;
    if (change.action.is_object() && change.action.value("act", "") == "load")
      throw Mistake("a program was loaded while the plant ran; restart it, so that the session holds one program a station");
    session.actions.push_back(change);
  }
  session.digest = runtime::state_digest(host.plant());
  return session;
}

std::string session_text(const Session& session) {
  Json texts = Json::object();
  for (const auto& [name, text] : session.texts) texts[name] = is_utf8(text) ? Json(text) : Json{{"bytes", widened(text)}};
  const nlohmann::ordered_json all{{kFormat, kVersion},
                                   {"plant", session.plant},
                                   {"moment", Json(session.moment)},
                                   {"digest", fmt::format("{:016x}", session.digest)},
                                   {"actions", Json(session.actions)},
                                   {"settings", session.settings},
                                   {"texts", texts}};
  return all.dump(1) + "\n";
}

Session read_session(std::string_view text) {
  if (text.find(kFormat) == std::string_view::npos) throw Mistake("this is no session of ipos");
  const Json all = Json::parse(text, nullptr, false);
  if (!all.is_object() || !all.contains(kFormat)) throw Mistake("the session is damaged or cut off");
  if (!all[kFormat].is_number_integer() || all[kFormat] != kVersion)
    throw Mistake(fmt::format("the session is of version {}, this ipos reads version {}", all[kFormat].dump(), kVersion));
  try {
    Session session;
    session.plant = all.at("plant").get<std::string>();
    session.moment = all.at("moment").get<debug::Position>();
    session.digest = std::stoull(all.at("digest").get<std::string>(), nullptr, 16);
    session.actions = all.at("actions").get<std::vector<debug::Change>>();
    session.settings = all.at("settings");
    for (const auto& [name, content] : all.at("texts").items()) {
      if (!is_inside(name)) throw Mistake(fmt::format("'{}' would lie outside of the session", name));
      session.texts[name] = content.is_string() ? content.get<std::string>() : narrowed(content.at("bytes").get<std::string>());
    }
    const bool in_order = std::is_sorted(session.actions.begin(), session.actions.end(),
                                         [](const auto& a, const auto& b) { return a.at < b.at; });
    if (!session.texts.contains(session.plant) || !session.settings.is_object() || !in_order ||
        session.moment.time < 0 || session.moment.phase > debug::Phase::Before || (!session.actions.empty() && session.actions.back().at > session.moment))
      throw Mistake("what stands in it makes no sense");
    return session;
  } catch (const Json::exception&) {
    throw Mistake("the session is damaged: a part of it is missing or is of another kind");
  } catch (const std::logic_error&) {  // of stoull
    throw Mistake("the session is damaged: its sum is no number");
  }
}

}  // namespace ipos::tools::serve
