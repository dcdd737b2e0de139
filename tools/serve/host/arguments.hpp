// What stands in a command message, checked: a member that is missing, of a wrong type or out of range is a Mistake in
// words.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace ipos::tools::serve {

using Json = nlohmann::json;

// A command that cannot be carried out, for a person.
class Mistake : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
// The same, said by the drive.
class Refusal : public Mistake {
 public:
  using Mistake::Mistake;
};

class Arguments {
 public:
  explicit Arguments(const Json& message) : message_(message) {}

  bool has(const char* key) const { return message_.contains(key) && !message_[key].is_null(); }
  const Json& json() const { return message_; }
  std::string text(const char* key) const;
  std::string text(const char* key, const std::string& otherwise) const;
  int64_t whole(const char* key, int64_t least, int64_t most) const;
  int64_t whole(const char* key, int64_t least, int64_t most, int64_t otherwise) const;
  double number(const char* key, double least, double most) const;
  double number(const char* key, double least, double most, double otherwise) const;
  bool flag(const char* key) const;
  bool flag(const char* key, bool otherwise) const;
  // At most `most` texts.
  std::vector<std::string> texts(const char* key, size_t most) const;

 private:
  const Json& at(const char* key) const;

  const Json& message_;
};

}  // namespace ipos::tools::serve
