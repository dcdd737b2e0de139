// A file as medium. It is locked while it is open, so that two runs do not share one unit's memory; who only
// looks gets a copy.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "runtime/nv_memory/medium/nv_medium.hpp"

namespace ipos::runtime {

enum class FileUse : uint8_t {
  Look,   // a copy of what the file holds now, beside a run that uses it; without a file nothing
  Write,  // made when it does not exist
};

// The file, or why it cannot be used.
tl::expected<std::unique_ptr<NvMedium>, std::string> open_file_medium(const std::string& path, FileUse use);

}  // namespace ipos::runtime
