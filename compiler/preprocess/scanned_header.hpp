// The built-in headers as tokens. Nearly every program includes one, and their text never changes, so each is scanned
// once in a process.
#pragma once

#include <span>

#include "compiler/preprocess/token.hpp"
#include "stdlib/embedded.hpp"

namespace ipos::compiler {

// Its tokens up to End, with places that count from 0. Empty for a header that is not one of ours.
std::span<const Token> scanned_header(const stdlib::EmbeddedFile& header);

}  // namespace ipos::compiler
