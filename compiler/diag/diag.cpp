// The table of diagnostics, the -W options, and the list of messages of one compilation.
#include "compiler/diag/diag.hpp"

#include <algorithm>
#include <utility>

namespace ipos::compiler {
namespace {

constexpr DiagInfo kTable[] = {
#define DIAGNOSTIC(code, name, severity, flag, format) \
  {Diag::name, code, #name, Severity::severity, flag, format},
#include "compiler/diag/diagnostics.def"
};

constexpr bool kOnAtFirst[] = {
#define DIAGNOSTIC(code, name, severity, flag, format) true,
#define OPT_IN(code, name, severity, flag, format) false,
#include "compiler/diag/diagnostics.def"
};

constexpr size_t kLongestArgument = 1000;  // ours: no name or list a person reads is longer

std::string fill_in(std::string_view format, const std::vector<std::string>& args) {
  std::string text;
  size_t next = 0;
  for (size_t at = 0; at < format.size(); ++at) {
    if (format.substr(at, 2) == "{}" && next < args.size()) {
      const std::string& arg = args[next++];
      text += arg.size() <= kLongestArgument ? arg : arg.substr(0, kLongestArgument) + "...";
      ++at;
    } else {
      text += format[at];
    }
  }
  return text;
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

}  // namespace

std::span<const DiagInfo> diagnostic_table() { return kTable; }

const DiagInfo& info(Diag diag) { return kTable[static_cast<size_t>(diag)]; }

bool WarningOptions::apply(std::string_view option) {
  if (option == "error" || option == "no-error") {
    all_errors_ = option == "error";
    return true;
  }
  const bool no = take_prefix(option, "no-");
  const bool error = take_prefix(option, "error=");
  const State state = error ? (no ? State::NeverError : State::AsError) : (no ? State::Off : State::On);
  if (states_.empty())
    for (const bool on : kOnAtFirst) states_.push_back(on ? State::On : State::Off);
  bool found = false;
  for (const DiagInfo& row : kTable) {
    if (row.severity != Severity::Warning || (option != "all" && option != row.flag)) continue;
    State& old = states_[static_cast<size_t>(row.diag)];
    // -Wflag only switches a warning on that is off; it does not take back -Werror=flag.
    if (state != State::On || old == State::Off) old = state;
    found = true;
  }
  return found;
}

Severity WarningOptions::severity(const DiagInfo& row) const {
  if (row.severity != Severity::Warning) return row.severity;
  const State state = !states_.empty()                            ? states_[static_cast<size_t>(row.diag)]
                      : kOnAtFirst[static_cast<size_t>(row.diag)] ? State::On
                                                                  : State::Off;
  switch (state) {
    case State::Off: return Severity::Note;
    case State::AsError: return Severity::Error;
    case State::NeverError: return Severity::Warning;
    case State::On: break;
  }
  return all_errors_ ? Severity::Error : Severity::Warning;
}

Diagnostic& Diagnostics::report(Diag diag, Span span, std::vector<std::string> args) {
  const DiagInfo& row = info(diag);
  const Severity severity = options_.severity(row);
  if (severity == Severity::Note && row.severity != Severity::Note) {  // it is off
    ignored_ = {};
    return ignored_;
  }
  if (severity == Severity::Error && errors_++ >= kMostErrors) {
    if (std::exchange(too_many_, true)) {
      ignored_ = {};
      return ignored_;
    }
    all_.push_back({Diag::TooManyErrors, severity, span, std::string(info(Diag::TooManyErrors).format), {}});
    if (diag == Diag::TooManyErrors) return all_.back();
    ignored_ = {};
    return ignored_;
  }
  all_.push_back({diag, severity, span, fill_in(row.format, args), {}});
  return all_.back();
}

}  // namespace ipos::compiler
