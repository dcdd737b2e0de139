// Any text to the compiler: an image or an error, never both and never none; an image that the verifier
// accepts; and messages that can be shown.
#include <set>
#include <tuple>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "tests/fuzz/programs.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const compiler::Compilation made = compiler::compile("fuzz.IPC", "", std::string(text_of(data, size)));
  require(made.image.has_value() != made.diagnostics.has_errors(), "there is an image or there are errors");
  const auto& messages = made.diagnostics.all();
  std::set<std::tuple<uint32_t, compiler::Diag, std::string>> told;
  for (const compiler::Diagnostic& message : messages) {
    require(!message.text.empty(), "a message has a text");
    require(told.emplace(message.span.begin.value, message.diag, message.text).second, "a mistake is told once");
  }
  require(messages.empty() == compiler::render_text(messages, *made.sources, false).empty(),
          "messages are shown");
  // They would be half of the time of all runs.
  if (size % 8 == 0) {
    require(messages.empty() == compiler::render_json(messages, *made.sources).empty(),
            "messages are shown as JSON");
    require(!compiler::render_sarif(messages, *made.sources).empty(), "SARIF has always a text");
  }
  if (!made.image) return 0;
  check_round_trips(*made.image);
  const auto limits = limits_of(made.image->unit);
  require(limits.has_value(), "an image is for a unit");
  const vm::Verification verified = vm::verify(made.image->code, *limits, {});
  require(verified.image.has_value(), "the verifier accepts what the compiler makes");
  check_execution(*verified.image, size);
  return 0;
}
