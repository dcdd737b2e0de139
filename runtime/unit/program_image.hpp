// An image of a file, as everything that runs or shows programs takes it. The container looks at itself
// (vm/image/image.hpp); this looks at what its tables mean for the unit and for those who show them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "vm/image/image.hpp"

namespace ipos::runtime {

// Or that it is "refused: ..." and why, for the user: the container is damaged, a symbol names variables that the unit does not have,
// which a viewer would read, or a name has control characters, which would act on the terminal that shows it.
tl::expected<vm::Image, std::string> read_program_image(std::span<const uint8_t> bytes);

}  // namespace ipos::runtime
