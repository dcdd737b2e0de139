// Requests of the debug adapter protocol at a run that goes on: it is shown, and nothing stops it or writes into it.
#include <fmt/format.h>

#include "tools/debug/dap.hpp"

namespace ipos::tools::debug {

Json DapServer::attach(const Json& arguments) {
  stop_on_entry_ = arguments.value("stopOnEntry", true);
  if (only_looks()) {
    told_ = debugger_->plant().journal().entries().size();  // what comes from now on
    return Json::object();
  }
  if (debugger_) throw ValueError("there is a session already");
  DapAttach run;
  if (arguments.contains("processId")) {
    const Json& process = arguments["processId"];  // a choice of the user is a text in some editors
    run.process = process.is_string() ? std::stoll("0" + process.get<std::string>()) : process.get<int64_t>();
  }
  attach_to(run);
  attached_ = true;
  return Json::object();
}

// What an editor sends in any session is answered as it is; all else is refused.
Json DapServer::look_instead(const std::string& command, const Json& arguments) {
  if (command == "pause" || command == "setExceptionBreakpoints") return Json::object();
  if (command == "continue") return {{"allThreadsContinued", true}};
  if (command.starts_with("set") && command.ends_with("reakpoints")) {
    Json all = Json::array();
    for (size_t n = 0; n < arguments.value("breakpoints", Json::array()).size(); ++n)
      all.push_back({{"verified", false}, {"message", "a run that is only looked at does not stop"}});
    return {{"breakpoints", std::move(all)}};
  }
  throw ValueError(fmt::format("the run is only looked at: '{}' would run, stop or change it", command));
}

// Behind the response.
void DapServer::tell_looks(const std::string& command) {
  if (command == "attach") {
    Json cannot = Json::object();
    for (const char* word : {"supportsFunctionBreakpoints", "supportsConditionalBreakpoints", "supportsHitConditionalBreakpoints",
                             "supportsLogPoints", "supportsStepBack", "supportsSetVariable", "supportsSetExpression",
                             "supportsDataBreakpoints", "supportsInstructionBreakpoints", "supportsTerminateRequest",
                             "supportsRestartRequest", "supportsGotoTargetsRequest", "supportsExceptionInfoRequest"})
      cannot[word] = false;
    event("capabilities", {{"capabilities", std::move(cannot)}});
    output(fmt::format("looks at the run of {}, which goes on: a pause shows it, and nothing stops it or writes into it\n", looks_at_));
  }
  if (command == "pause" || (command == "configurationDone" && stop_on_entry_)) {
    shows_ = true;
    tell_stop("pause", "shown", {}, {});
  }
  if (command == "continue" || command == "terminate") shows_ = false;
}

void DapServer::show_again() {
  if (!only_looks()) return;
  tell_journal();
  if (shows_ && refreshes_) event("invalidated", {{"areas", Json::array({"all"})}});
}

}  // namespace ipos::tools::debug
