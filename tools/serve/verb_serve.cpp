// ipos serve: a page to watch and touch a plant. Two halves: this process is the server, another one has the plant, so that no
// browser can keep the plant waiting, and a copy of the plant can take its place when time goes back. Where processes cannot be
// copied the other half is a thread.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>

#include "tools/cli/end_of_process.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/links/link_options.hpp"
#include "tools/processes/replaceable_process.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/drive_host.hpp"
#include "tools/serve/gallery_host.hpp"
#include "tools/serve/host/plant_host.hpp"
#include "tools/serve/host_copies.hpp"
#include "tools/serve/kept.hpp"
#include "tools/serve/language.hpp"
#include "tools/serve/opened_page.hpp"
#include "tools/serve/opened_session.hpp"
#include "tools/serve/page.hpp"
#include "tools/serve/plant_files.hpp"
#include "tools/serve/plant_ports.hpp"
#include "tools/serve/server.hpp"
#include "tools/serve/sockets.hpp"
#include "tools/survivors/survivors.hpp"
#include "tools/testing/debugged_test.hpp"

namespace ipos::tools {
namespace {

struct ServeFlags {
  std::string file;
  std::shared_ptr<const serve::OpenedSession> session{};  // FILE was one; `file` is its plant
  std::optional<sessions::OfTest> test{};  // FILE was one; `file` is its plant
  std::string test_case;
  std::string bind = "127.0.0.1";
  uint16_t port = 0;
  bool open = false;
  LinkFlags device;  // with a port: a real drive
  std::string address = "1";
  bool write = false;
  bool snapshots = true;
  CompileFlags compile;
};

// A process of its own leaves the server's end of the line to the server, so that each sees when the other is gone, and
// Ctrl-C, which goes to both, too.
void begin_host(const serve::SocketPair& sockets) {
  if (!ReplaceableProcess::kHasCopies) return;
  serve::close_socket(sockets.server);
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
}

// The gallery is that of a folder; a session has its own.
serve::Kept kept_of(const ServeFlags& flags) {
  if (flags.session) return serve::Kept::of_plant(flags.session->path());
  if (flags.test) return serve::Kept::of_plant(flags.test->file);
  return flags.device.port.empty() ? serve::Kept::of_plant(flags.file.empty() ? "." : flags.file)
                                   : serve::Kept::of_drive(flags.device.port, flags.address);
}

constexpr int kMessagesAtOnce = 8;  // a client that floods does not hold the plant up
constexpr int kLongestWait = 100;   // ms; then the tabs have their turn

// Turns of the host, and what comes between them, until nobody listens any more.
void run(serve::PlantHost& host, serve::Mailbox& mailbox) {
  using std::chrono::milliseconds;
  while (mailbox.open()) {
    const auto due = host.turn();
    const auto now = serve::WallClock::now();
    const auto left = std::chrono::ceil<milliseconds>(std::clamp(due, now, now + milliseconds(kLongestWait)) - now);
    for (int n = 0; n < kMessagesAtOnce; ++n) {
      const auto message = mailbox.wait(n == 0 ? static_cast<int>(left.count()) : 0);
      if (!message) break;
      host.take(*message);
    }
  }
}

// Who is at another machine changes no files of this one unless that is wanted.
std::string why_read_only(const ServeFlags& flags) {
  if (flags.write || flags.bind.starts_with("127.") || flags.bind == "::1") return "";
  return "this page can be reached from other machines: files are written with ipos serve --write only";
}

// Until somebody opens a plant, which can be built; its path. Empty: nobody listens any more.
std::string run_gallery(const ServeFlags& flags, serve::Mailbox& mailbox, PlantInput& input) {
  const serve::SteadyClock clock;
  serve::GalleryHost gallery(
      mailbox, clock,
      {IPOS_VERSION, why_read_only(flags), [] { return plants_in(""); },
       [&](const std::string& path) { input = read_plant_input(path, flags.compile); }});
  kept_of(flags).add_commands(gallery.router());
  mailbox.send(serve::MessageKind::Ready, 0, {});
  while (mailbox.open() && gallery.opened().empty())
    if (const auto message = mailbox.wait(kLongestWait)) gallery.take(*message);
  return gallery.opened();
}

int run_host(ServeFlags flags, PlantInput input, const serve::SocketPair& sockets) {
  begin_host(sockets);
  serve::Channel channel(sockets.host);
  const bool chosen = flags.file.empty();
  if (chosen && (flags.file = run_gallery(flags, channel, input)).empty()) return kGood;
  const bool snapshots = flags.snapshots && !serve::PlantPorts::has_ports(input.file);
  const std::string title = std::filesystem::path(flags.test ? flags.test->file : flags.file).filename().string();
  const serve::SteadyClock clock;
  const std::unique_ptr<serve::Copies> copies = serve::host_copies(snapshots);
  serve::PlantPorts ports;
  serve::PlantFiles files(flags.file, flags.compile,
                          flags.session && flags.session->is_unpacked() ? serve::kFilesOfSession : why_read_only(flags),
                          flags.test);
  serve::LanguageServer language(flags.compile, kept_survivors);
  debug::Debuggee what([input = std::move(input)] { return make_plant(input, runtime::FileUse::Look); });
  if (flags.test) what = serve::debuggee_of(*flags.test, flags.compile);
  serve::PlantHost host(std::move(what), title, IPOS_VERSION, {channel, clock, *copies, ports, files, language});
  const serve::Kept kept = kept_of(flags);
  kept.add_commands(host.router());
  if (flags.session) flags.session->resume(host);
  host.restore(kept.settings());
  if (!chosen) channel.send(serve::MessageKind::Ready, 0, {});
  run(host, channel);
  return kGood;
}

int run_drive_host(const ServeFlags& flags, const serve::SocketPair& sockets) {
  std::unique_ptr<BusLink> link = BusLink::open(flags.device);
  begin_host(sockets);
  serve::Channel channel(sockets.host);
  serve::DriveHost host(
      std::move(link),
      {static_cast<uint8_t>(std::stoi(flags.address)), flags.compile.unit, flags.write, IPOS_VERSION},
      channel);
  kept_of(flags).add_commands(host.router());
  channel.send(serve::MessageKind::Ready, 0, {});
  host.run();
  return kGood;
}

int serve_page(ServeFlags flags) {
  const bool device = !flags.device.port.empty();
  if (device && !flags.file.empty())
    throw Failure(kUsage, "serve takes a FILE, or --device with the port of a real drive, not both");
  if (!device) {
    // Nothing was named and nothing can be told: the gallery opens.
    if (flags.file.empty() && plants_in("").size() == 1) flags.file = plants_in("").front();
    if (!flags.file.empty()) flags.file = plant_or_program(flags.file);
  }
  if (serve::is_session(flags.file)) {
    flags.session = std::make_shared<const serve::OpenedSession>(flags.file);
    flags.file = flags.session->plant();
    flags.test = flags.session->beside();
  } else if (kind_of_file(flags.file) == runtime::TomlKind::Test) {
    flags.test = sessions::OfTest{flags.file, flags.test_case};
  }
  if (!flags.test_case.empty() && kind_of_file(flags.file) != runtime::TomlKind::Test)
    throw Failure(kUsage, "--case chooses a case of a test (NAME.test.toml)");
  PlantInput input;
  if (flags.test) {
    const auto test = testing::chosen_test(flags.test->file, flags.test->test_case);
    flags.file = test->plant_path;
    input.file = test->plant;
  } else if (!flags.file.empty()) {
    input = read_plant_input(flags.file, flags.compile);
  }
  const serve::SocketPair sockets = serve::make_socket_pair();
  ReplaceableProcess host([&] {
    const int code = end_of_process(
        [&] { return device ? run_drive_host(flags, sockets) : run_host(flags, std::move(input), sockets); });
    serve::close_socket(sockets.host);
    return code;
  });
  if (!host.started()) throw Failure(kIoError, "there is no room for another process");
  if (ReplaceableProcess::kHasCopies) serve::close_socket(sockets.host);
  serve::OwnedSocket line(sockets.server);  // with its end the host ends
  catch_interrupts();
  bool was_there = false;
  std::optional<serve::OpenedPage> page;
  {
    const serve::Kept kept = kept_of(flags);
    serve::ServerOptions options;
    options.bind = flags.bind;
    options.port = flags.port;
    if (flags.port == 0) options.rather = kept.port();
    options.token = kept.token();
    options.page = serve::embedded_files().front().text;
    serve::Server server(options, line.release());
    kept.keep_port(server.port());
    server.run([&] {
      was_there = true;
      fmt::print("{}\n", server.address());
      std::fflush(stdout);
      if (flags.open) page.emplace(server.address());
    });
  }
  const int code = host.wait();
  if (code < 0) throw Failure(kInternal, "the process with the plant has ended");
  return was_there ? code : (code == kGood ? kInterrupted : code);
}

}  // namespace

void add_serve(cli::Verb& app) {
  auto flags = std::make_shared<ServeFlags>();
  cli::Verb& verb = app.verb("serve", "a page in the browser to watch, touch and understand a plant");
  verb.option("FILE", flags->file,
              "plant (.toml) or its folder, source (.IPC), image (.ipx), session (.ipos), test (.test.toml) with what it does; default: the only plant here, else the gallery");
  verb.option("--case", flags->test_case, "case of a test that has several");
  verb.option("--port", flags->port, "port to listen at; default 0: that of the last time, or any free one");
  verb.option("--bind", flags->bind, "address to listen at; default 127.0.0.1, which others cannot reach");
  verb.flag("--open", flags->open, "open the page in a browser");
  verb.option("--device", flags->device.port,
              "in place of FILE: a real drive at can0, slcan:/dev/ttyACM0 or /dev/ttyUSB0");
  verb.option("--address", flags->address, "address of that drive, default 1")
      .check(check_address, "ADDRESS");
  verb.flag("--write", flags->write, "let the page write to that drive, which it asks once more, or files of the plant beyond loopback");
  add_link_options(verb, flags->device, false);
  verb.off("--no-snapshots", flags->snapshots, "go back in time by running again from the beginning");
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos serve examples/sbus-line/line.toml --open");
  verb.runs([flags] { return serve_page(*flags); });
}

}  // namespace ipos::tools
