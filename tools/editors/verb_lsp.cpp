// ipos lsp: the language server on standard input and output.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <memory>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/cli/whole_bytes.hpp"
#include "tools/lsp/server.hpp"
#include "tools/lsp_base/transport.hpp"
#include "tools/survivors/survivors.hpp"

namespace ipos::tools {
namespace {

void send(const lsp::Json& message) {
  // Bytes of a source that are no UTF-8 must not end the connection.
  const std::string text = lsp::framed(message.dump(-1, ' ', false, lsp::Json::error_handler_t::replace));
  if (!write_all(STDOUT_FILENO, text.data(), text.size())) throw Failure(kIoError, "the editor does not listen any more");
}

constexpr int kLookEvery = 1000;  // ms

// Reads all there is before each answer, so that a cancellation overtakes what it cancels and many changes
// give one compilation.
int serve() {
  lsp::Server server(try_read_file, send);
  server.show_survivors(kept_survivors);
  lsp::MessageReader reader;
  char buffer[65536];
  bool open = true;
  while (!server.ended() && (open || server.waiting())) {
    while (open && (readable(STDIN_FILENO, 0) || !server.run())) {
      if (server.ended()) return server.exit_code();
      if (!readable(STDIN_FILENO, kLookEvery)) {
        server.look_at_survivors();
        continue;
      }
      const ssize_t count = read(STDIN_FILENO, buffer, sizeof buffer);
      if (count < 0 && errno == EINTR) continue;
      open = count > 0;
      if (open) reader.feed({buffer, static_cast<size_t>(count)});
      while (const auto body = reader.next()) server.receive(*body);
      if (reader.broken()) throw Failure(kBadInput, "the input is no language server protocol");
    }
    while (!open && server.run()) {
    }
  }
  return server.exit_code();
}

}  // namespace

void add_lsp(cli::Verb& app) {
  cli::Verb& verb = app.verb("lsp", "language server for editors, on standard input and output");
  auto stdio = std::make_shared<bool>(true);
  verb.flag("--stdio", *stdio, "the only way to talk; accepted for editors that say so");
  verb.footer("Example, in an editor's settings:\n  command: ipos lsp");
  verb.runs([stdio] { return serve(); });
}

}  // namespace ipos::tools
