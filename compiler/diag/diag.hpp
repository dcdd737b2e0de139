// Diagnostics are data: a coded message with its place, arguments and notes. diagnostics.def is the one table
// of codes; render.hpp makes text, JSON or SARIF of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/source/source.hpp"

namespace ipos::compiler {

enum class Severity : uint8_t { Note, Warning, Error };

// Names of the rows of diagnostics.def, for example Diag::UnknownName.
enum class Diag : uint16_t {
#define DIAGNOSTIC(code, name, severity, flag, format) name,
#include "compiler/diag/diagnostics.def"
};

struct DiagInfo {
  Diag diag;
  std::string_view code;  // "E0123", "W0012", or of a note, which no option makes an error, "N0219"
  std::string_view name;  // C++ name
  Severity severity;
  std::string_view flag;    // of -W...: "unused-variable"; empty for errors and notes
  std::string_view format;  // of the message; each {} takes the next argument
};
std::span<const DiagInfo> diagnostic_table();
const DiagInfo& info(Diag diag);

struct Note {
  Span span;  // may be invalid: a note without a place
  std::string text;
};

struct Diagnostic {
  Diag diag;
  Severity severity;  // after -Werror and the like
  Span span;
  std::string text;  // the finished message, without place and code
  std::vector<Note> notes;
};

// Which warnings are on and what they count as: -W<flag>, -Wno-<flag>, -Werror, -Werror=<flag>,
// -Wno-error=<flag>, -Wall, -Wno-all. All but the OPT_IN rows are on at first; later options win over earlier ones.
class WarningOptions {
 public:
  // False when no warning has that flag. `option` is the text after "-W".
  bool apply(std::string_view option);
  // Severity of a row under these options, or Note for "off".
  Severity severity(const DiagInfo& row) const;

 private:
  enum class State : uint8_t { On, Off, AsError, NeverError };
  bool all_errors_ = false;
  std::vector<State> states_;  // by row of the table; empty: all on
};

// Collects the diagnostics of one compilation, in the order found.
class Diagnostics {
 public:
  // Ours; TooManyErrors stands after them.
  static constexpr uint32_t kMostErrors = 100;

  explicit Diagnostics(WarningOptions options = {}) : options_(std::move(options)) {}

  // Adds a message; its text is the row's format with args filled in. Returns it so that notes can be added.
  // A warning that is off, and an error after the hundredth, goes to a place nobody reads.
  Diagnostic& report(Diag diag, Span span, std::vector<std::string> args = {});

  bool has_errors() const { return errors_ != 0; }
  uint32_t error_count() const { return errors_; }
  const std::vector<Diagnostic>& all() const { return all_; }

 private:
  WarningOptions options_;
  std::vector<Diagnostic> all_;
  Diagnostic ignored_{};
  uint32_t errors_ = 0;  // those that nobody reads, too
  bool too_many_ = false;
};

}  // namespace ipos::compiler
