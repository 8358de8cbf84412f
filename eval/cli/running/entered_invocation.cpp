#include "eval/cli/running/entered_invocation.hpp"

#include <fmt/format.h>

#include <system_error>

namespace fusebench::cli::running {

Result<engine::Invocation> enter_invocation(const std::filesystem::path& file) {
  auto invocation = engine::read_invocation(file);
  if (!invocation) return invocation;
  const std::filesystem::path& folder = invocation->working_folder;
  std::error_code error;
  std::filesystem::current_path(folder, error);
  if (!error) return invocation;
  return fail(ErrorCode::data_missing,
              fmt::format("{}: the folder where the suite was started cannot be entered: {}", folder.string(),
                          error.message()));
}

}  // namespace fusebench::cli::running
