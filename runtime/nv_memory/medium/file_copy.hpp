// What who only looks at a file gets: a copy in memory.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "runtime/nv_memory/medium/nv_medium.hpp"

namespace ipos::runtime {

// Of what `file` holds now, or why it cannot be read.
tl::expected<std::unique_ptr<NvMedium>, std::string> copy_of(NvMedium& file);

// Of a file that is not there.
std::unique_ptr<NvMedium> copy_of_nothing();

}  // namespace ipos::runtime
