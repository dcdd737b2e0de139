// One JSON object. Its first member is the format with its version; a text that is not UTF-8 stands in it byte by byte.
#include "tools/sessions/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ipos::tools::sessions {
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
    if ((first & 0xFCU) != 0xC0 || n + 1 == text.size()) throw Unreadable("a text of bytes has another character");
    bytes += static_cast<char>((first & 0x03U) << 6U | (static_cast<unsigned char>(text[++n]) & 0x3FU));
  }
  return bytes;
}

bool is_utf8(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore) == Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

bool is_inside(const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  return !name.empty() && path.is_relative() && *path.begin() != ".." && name.find('\\') == std::string::npos;
}

std::string common_folder(const std::vector<std::string>& files) {
  fs::path folder = fs::absolute(files.front()).lexically_normal().parent_path();
  for (const std::string& file : files) {
    const fs::path other = fs::absolute(file).lexically_normal();
    fs::path shared;
    for (auto a = folder.begin(), b = other.begin(); a != folder.end() && b != other.end() && *a == *b; ++a, ++b) shared /= *a;
    folder = shared;
  }
  return folder.generic_string();
}

std::string name_in(const std::string& folder, const std::string& file) {
  return fs::absolute(file).lexically_normal().lexically_relative(folder).generic_string();
}

std::string session_text(const Session& session) {
  Json texts = Json::object();
  for (const auto& [name, text] : session.texts) texts[name] = is_utf8(text) ? Json(text) : Json{{"bytes", widened(text)}};
  const nlohmann::ordered_json all{{kFormat, kVersion},
                                   {"plant", session.plant},
                                   {"test", session.test ? Json(*session.test) : Json(nullptr)},
                                   {"moment", Json(session.moment)},
                                   {"digest", fmt::format("{:016x}", session.digest)},
                                   {"actions", Json(session.actions)},
                                   {"settings", session.settings},
                                   {"texts", texts}};
  return all.dump(1) + "\n";
}

Session read_session(std::string_view text) {
  if (text.find(kFormat) == std::string_view::npos) throw Unreadable("this is no session of ipos");
  const Json all = Json::parse(text, nullptr, false);
  if (!all.is_object() || !all.contains(kFormat)) throw Unreadable("the session is damaged or cut off");
  if (!all[kFormat].is_number_integer() || all[kFormat] != kVersion)
    throw Unreadable(fmt::format("the session is of version {}, this ipos reads version {}", all[kFormat].dump(), kVersion));
  try {
    Session session;
    session.plant = all.at("plant").get<std::string>();
    if (const Json test = all.value("test", Json(nullptr)); !test.is_null()) session.test = test.get<OfTest>();
    session.moment = all.at("moment").get<debug::Position>();
    session.digest = std::stoull(all.at("digest").get<std::string>(), nullptr, 16);
    session.actions = all.at("actions").get<std::vector<debug::Change>>();
    session.settings = all.at("settings");
    for (const auto& [name, content] : all.at("texts").items()) {
      if (!is_inside(name)) throw Unreadable(fmt::format("'{}' would lie outside of the session", name));
      session.texts[name] = content.is_string() ? content.get<std::string>() : narrowed(content.at("bytes").get<std::string>());
    }
    const bool in_order = std::is_sorted(session.actions.begin(), session.actions.end(),
                                         [](const auto& a, const auto& b) { return a.at < b.at; });
    if (!session.texts.contains(session.plant) || (session.test && !session.texts.contains(session.test->file)) || !session.settings.is_object() || !in_order ||
        session.moment.time < 0 || session.moment.phase > debug::Phase::Before || (!session.actions.empty() && session.actions.back().at > session.moment))
      throw Unreadable("what stands in it makes no sense");
    return session;
  } catch (const Json::exception&) {
    throw Unreadable("the session is damaged: a part of it is missing or is of another kind");
  } catch (const std::logic_error&) {  // of stoull
    throw Unreadable("the session is damaged: its sum is no number");
  }
}

}  // namespace ipos::tools::sessions
