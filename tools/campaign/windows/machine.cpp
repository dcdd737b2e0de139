// Processes and files of Windows.
#include "tools/campaign/machine.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>

#include <cerrno>
#include <filesystem>
#include <sstream>

namespace ipos::tools::campaign {
namespace {

std::string this_machine() {
  char name[MAX_COMPUTERNAME_LENGTH + 1] = "";
  DWORD size = sizeof name;
  GetComputerNameA(name, &size);
  return fmt::format("{}/windows", name);
}

// When it began; 0 where there is none.
uint64_t start_of(DWORD process) {
  const HANDLE handle = OpenProcess(PROCESS_QUERY_LIMITED_INFORMATION, FALSE, process);
  if (handle == nullptr) return 0;
  FILETIME begun{}, ended{}, kernel{}, user{};
  DWORD code = 0;
  const bool runs = GetExitCodeProcess(handle, &code) != 0 && code == STILL_ACTIVE;
  GetProcessTimes(handle, &begun, &ended, &kernel, &user);
  CloseHandle(handle);
  return runs ? uint64_t{begun.dwHighDateTime} << 32U | begun.dwLowDateTime : 0;
}

}  // namespace

std::string this_process() {
  return fmt::format("{} {} {}", this_machine(), GetCurrentProcessId(), start_of(GetCurrentProcessId()));
}

bool is_own_process(const std::string& name) { return name == this_process(); }

std::optional<bool> is_alive(const std::string& name) {
  std::istringstream fields(name);
  std::string machine;
  DWORD process = 0;
  uint64_t start = 0;
  fields >> machine >> process >> start;
  if (machine != this_machine()) return std::nullopt;
  return start != 0 && start_of(process) == start;
}

bool write_whole(const runtime::Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const int done = _write(file.get(), bytes.data(), static_cast<unsigned>(bytes.size()));
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(done));
  }
  return true;
}

runtime::Descriptor open_to_append(const std::string& path) {
  return runtime::Descriptor(_open(path.c_str(), _O_RDWR | _O_CREAT | _O_APPEND | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE));
}

bool cut(const runtime::Descriptor& file, size_t size) { return _chsize_s(file.get(), static_cast<int64_t>(size)) == 0; }

bool bring_to_disk(const runtime::Descriptor& file) { return _commit(file.get()) == 0; }

void bring_folder_to_disk(const std::string& /*folder*/) {}  // Windows brings names to the disk with their files

int run_again(const std::vector<std::string>& arguments) {
  wchar_t program[32'768] = L"";
  GetModuleFileNameW(nullptr, program, 32'768);
  std::vector<std::wstring> words{L"ipos"};
  for (const std::string& argument : arguments) words.push_back(L'"' + std::filesystem::path(argument).wstring() + L'"');
  std::vector<const wchar_t*> pointers;
  for (const std::wstring& word : words) pointers.push_back(word.c_str());
  pointers.push_back(nullptr);
  return static_cast<int>(_wspawnv(_P_WAIT, program, pointers.data()));
}

}  // namespace ipos::tools::campaign
