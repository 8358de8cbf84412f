#include "eval/trajectory/stamped_list.hpp"

#include "core/stamped_rows.hpp"

namespace fusebench {

Result<std::vector<std::int64_t>> read_stamps(const std::filesystem::path& file) {
  std::vector<std::int64_t> stamps;
  const Result<void> done = for_each_stamped_row(file, "timestamp filename", TimeOrder::increasing,
                                                 [&](const TextTable&, std::int64_t time_ns) -> Result<void> {
                                                   stamps.push_back(time_ns);
                                                   return {};
                                                 });
  if (!done) return tl::unexpected(done.error());
  return stamps;
}

}  // namespace fusebench
