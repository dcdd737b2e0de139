// The compiler behind its C interface. The only place outside tools/ that catches: containers of the compiler
// throw when there is no memory, and that must not reach a caller in C.
#include "embed/include/ipos_compile.h"

#include <algorithm>
#include <cstring>

#include "compiler/compile.hpp"
#include "compiler/diag/once.hpp"
#include "compiler/diag/render.hpp"

namespace {

using namespace ipos;  // NOLINT

std::vector<std::string> texts(const char* const* list, size_t count) {
  std::vector<std::string> out;
  for (size_t n = 0; n < count; ++n) out.emplace_back(list[n]);
  return out;
}

std::optional<std::string> read(const ipos_compile_job& job, const std::string& path) {
  std::string text;
  const ipos_add_bytes add = [](void* sink, const char* bytes, size_t size) {
    static_cast<std::string*>(sink)->append(bytes, size);
  };
  if (!job.read_file(job.user, path.c_str(), add, &text)) return std::nullopt;
  return text;
}

void put_messages(ipos_compile_job& job, const std::string& text) {
  job.messages_size = text.size();
  if (job.messages_capacity == 0) return;
  const size_t fits = std::min(text.size(), job.messages_capacity - 1);
  std::memcpy(job.messages, text.data(), fits);
  job.messages[fits] = '\0';
}

ipos_status compile(ipos_compile_job& job) {
  compiler::CompileOptions options;
  options.include_dirs = texts(job.include_dirs, job.include_dir_count);
  options.defines = texts(job.defines, job.define_count);
  if (job.read_file != nullptr)
    options.read_file = [&job](const std::string& path) { return read(job, path); };
  if (job.unit != nullptr) {
    options.unit = stdlib::find_unit(std::string_view(job.unit));
    if (options.unit == nullptr || options.unit->tasks == 0) return IPOS_UNKNOWN_UNIT;
  }
  const std::string source =
      job.source_size == 0 ? std::string(job.source) : std::string(job.source, job.source_size);
  const compiler::Compilation made = compiler::compile(job.name, job.name, source, options);
  put_messages(job, compiler::render_text(compiler::each_once(made.diagnostics.all(), *made.sources), *made.sources, false));
  if (!made.image) return IPOS_SOURCE_ERROR;
  const std::vector<uint8_t> image = vm::write_image(*made.image);
  job.image_size = image.size();
  if (job.image_capacity < image.size()) return IPOS_MEMORY_TOO_SMALL;
  std::memcpy(job.image, image.data(), image.size());
  return IPOS_OK;
}

bool has_null(const char* const* list, size_t count) {
  if (count == 0) return false;
  return list == nullptr || std::find(list, list + count, nullptr) != list + count;
}

}  // namespace

ipos_status ipos_compile(ipos_compile_job* job) {
  if (job == nullptr) return IPOS_INVALID_ARGUMENT;
  job->image_size = 0;
  job->messages_size = 0;
  if (job->name == nullptr || job->source == nullptr || has_null(job->defines, job->define_count) ||
      has_null(job->include_dirs, job->include_dir_count) ||
      (job->image == nullptr && job->image_capacity != 0) ||
      (job->messages == nullptr && job->messages_capacity != 0))
    return IPOS_INVALID_ARGUMENT;
  try {
    return compile(*job);
  } catch (...) {
    job->image_size = 0;
    return IPOS_OUT_OF_MEMORY;
  }
}
