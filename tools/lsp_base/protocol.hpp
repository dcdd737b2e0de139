// The frame of the protocol: JSON, error codes, and how a handler refuses a request.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace ipos::tools::lsp {

using Json = nlohmann::json;

// CompletionItemKind of LSP 3.17.
enum ItemKind : int {
  kFunction = 3,
  kField = 5,
  kVariable = 6,
  kValue = 12,
  kKeyword = 14,
  kFile = 17,
  kConstant = 21,
  kStruct = 22
};

// JSON-RPC 2.0 and LSP 3.17.
enum class ErrorCode : int {
  ParseError = -32700,
  InvalidRequest = -32600,
  MethodNotFound = -32601,
  InvalidParams = -32602,
  InternalError = -32603,
  NotInitialized = -32002,
  RequestCancelled = -32800,
  RequestFailed = -32803,
};

class RequestError : public std::runtime_error {
 public:
  RequestError(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace ipos::tools::lsp
