// ipos trace: what a run has written as .ipos-trace, as the texts and pictures that the run would have made itself.
#include <fmt/format.h>

#include <filesystem>

#include "compiler/diag/places.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/recording/plot_html.hpp"
#include "tools/recording/plot_svg.hpp"
#include "tools/recording/trace_file.hpp"
#include "tools/recording/trace_forms.hpp"

namespace ipos::tools {
namespace {

// Reads a file from its beginning, as often as wanted.
class Trace {
 public:
  explicit Trace(const std::string& path) : path_(path), bytes_(read_file(path, kLogLimit)) {}

  template <typename Take>
  void read(Take take) const {
    TraceReader reader(bytes_);
    if (const auto mistake = reader.begin()) fail(*mistake);
    take.begin(reader);
    RecordedPart part;
    for (;;) {
      const auto more = reader.next(part);
      if (!more) fail(more.error());
      if (!*more) break;
      take.part(part);
    }
    take.end(reader);
  }

  std::string place(size_t offset) const { return fmt::format("{}: byte {}", compiler::printable(path_), offset); }

 private:
  [[noreturn]] void fail(const TraceMistake& mistake) const {
    throw Failure(kBadInput, fmt::format("{}: {}", place(mistake.offset), mistake.text));
  }

  std::string path_;
  std::string bytes_;
};

// The first time: nothing is written of a file that is damaged further on.
struct Look {
  const Trace& trace;
  void begin(const TraceReader&) {}
  void part(const RecordedPart&) {}
  void end(const TraceReader& reader) {
    if (const auto offset = reader.ends_early())
      fmt::print(stderr, "{}: warning: the trace ends here, without its last block: the run was killed, or has not ended\n",
                 trace.place(*offset));
  }
};

// The second time: a text, or the whole for a picture.
struct Text {
  std::ostream& out;
  TraceForm form;
  std::unique_ptr<TraceWriter> writer = nullptr;
  void begin(const TraceReader& reader) { writer = form(out, reader.signals(), reader.tracks()); }
  void part(const RecordedPart& part) { writer->take(part); }
  void end(const TraceReader&) { writer->finish(); }
};

struct Picture {
  Recording& recording;
  std::vector<nlohmann::json>& channels;
  void begin(const TraceReader& reader) {
    recording.signals = reader.signals();
    recording.tracks = reader.tracks();
    recording.samples.resize(recording.signals.size());
    channels = reader.channels();
  }
  void part(const RecordedPart& part) { add_part(recording, part); }
  void end(const TraceReader&) {}
};

void write_text(const Trace& trace, TraceForm form, const std::string& path) {
  LogOutput out(path);
  trace.read(Text{out.stream(), form});
  out.finish();
}

void write_picture(const Trace& trace, bool html, const std::string& title, const std::string& path) {
  Recording recording;
  std::vector<nlohmann::json> channels;
  trace.read(Picture{recording, channels});
  replace_file(path, html ? plot_html_of(recording, channels, title) : plot_svg(recording, title));
}

void add_export(cli::Verb& app) {
  struct Flags {
    std::string file;
    std::string out = "-";
    std::string form = "csv";
  };
  auto flags = std::make_shared<Flags>();
  cli::Verb& verb = app.verb("export", "write a trace as the text, or draw the picture, that the run would have made");
  verb.option("FILE", flags->file, "trace (.ipos-trace) of a run").required();
  verb.option("-o", flags->out, "file to write, in the form of its ending: .csv, .vcd, .jsonl, or a picture, .svg or .html; - is standard output");
  verb.option("--form", flags->form, "of standard output: csv, vcd or jsonl").one_of({"csv", "vcd", "jsonl"});
  verb.footer("Example:\n  ipos trace export run.ipos-trace -o run.csv");
  verb.runs([flags] {
    const std::string ending = output_ending("trace export -o", flags->out);
    const Trace trace(flags->file);
    trace.read(Look{trace});
    if (ending == ".svg" || ending.starts_with(".htm"))
      write_picture(trace, ending != ".svg", std::filesystem::path(flags->file).filename().string(), flags->out);
    else
      write_text(trace, trace_form(ending.empty() ? "." + flags->form : ending), flags->out);
    return kGood;
  });
}

}  // namespace

void add_trace(cli::Verb& app) {
  cli::Verb& verb = app.verb("trace", "make texts and pictures of the packed trace of a run");
  add_export(verb);
  verb.footer("Example:\n  ipos trace export run.ipos-trace -o run.csv");
}

}  // namespace ipos::tools
