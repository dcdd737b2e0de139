// Every wrong type is told by name of the member.
#include "tools/serve/host/arguments.hpp"

#include <fmt/format.h>

namespace ipos::tools::serve {

const Json& Arguments::at(const char* key) const {
  if (!has(key)) throw Mistake(fmt::format("'{}' is missing", key));
  return message_[key];
}

std::string Arguments::text(const char* key) const {
  const Json& value = at(key);
  if (!value.is_string()) throw Mistake(fmt::format("'{}' must be a text", key));
  return value.get<std::string>();
}

std::string Arguments::text(const char* key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

int64_t Arguments::whole(const char* key, int64_t least, int64_t most) const {
  const Json& value = at(key);
  if (!value.is_number_integer()) throw Mistake(fmt::format("'{}' must be a whole number", key));
  const bool too_large = value.is_number_unsigned() && value.get<uint64_t>() > INT64_MAX;
  const int64_t number = too_large ? INT64_MAX : value.get<int64_t>();
  if (too_large || number < least || number > most)
    throw Mistake(fmt::format("'{}' must be {} to {}", key, least, most));
  return number;
}

int64_t Arguments::whole(const char* key, int64_t least, int64_t most, int64_t otherwise) const {
  return has(key) ? whole(key, least, most) : otherwise;
}

double Arguments::number(const char* key, double least, double most) const {
  const Json& value = at(key);
  if (!value.is_number()) throw Mistake(fmt::format("'{}' must be a number", key));
  const auto number = value.get<double>();
  if (!(number >= least && number <= most))
    throw Mistake(fmt::format("'{}' must be {} to {}", key, least, most));
  return number;
}

double Arguments::number(const char* key, double least, double most, double otherwise) const {
  return has(key) ? number(key, least, most) : otherwise;
}

bool Arguments::flag(const char* key) const {
  const Json& value = at(key);
  if (!value.is_boolean()) throw Mistake(fmt::format("'{}' must be true or false", key));
  return value.get<bool>();
}

bool Arguments::flag(const char* key, bool otherwise) const { return has(key) ? flag(key) : otherwise; }

std::vector<std::string> Arguments::texts(const char* key, size_t most) const {
  const Json& value = at(key);
  if (!value.is_array() || value.size() > most)
    throw Mistake(fmt::format("'{}' must be a list of at most {} texts", key, most));
  std::vector<std::string> texts;
  for (const Json& item : value) {
    if (!item.is_string()) throw Mistake(fmt::format("'{}' must be a list of texts", key));
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

}  // namespace ipos::tools::serve
