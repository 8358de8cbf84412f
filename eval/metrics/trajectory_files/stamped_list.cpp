#include "eval/metrics/trajectory_files/stamped_list.hpp"

#include "core/base/io/stamped_rows.hpp"

namespace fusebench::trajectory_files {

Result<std::vector<std::int64_t>> read_stamps(const std::filesystem::path& file,
                                              std::vector<std::string>& warnings) {
  std::vector<std::int64_t> stamps;
  const Result<void> done = io::for_each_stamped_row(
      file, "timestamp filename", io::TimeOrder::increasing,
      [&](const io::TextTable&, std::int64_t time_ns) -> Result<void> {
        stamps.push_back(time_ns);
        return {};
      },
      warnings);
  if (!done) return tl::unexpected(done.error());
  return stamps;
}

}  // namespace fusebench::trajectory_files
