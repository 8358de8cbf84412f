#include "eval/run_files/nees_table.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/io/stamped_rows.hpp"
#include "core/io/text_table.hpp"
#include "core/trajectory/trajectory_file.hpp"

namespace fusebench::run_files {

std::string nees_table(const record::RecordedNees& nees) {
  std::string text;
  for (const record::Outcome<metrics::NeesResult>& part : nees) {
    if (!part.value) continue;
    if (text.empty()) text = "# capture_timestamp,part,nees_per_dof\n";
    for (std::size_t i = 0; i < part.value->at_ns.size(); ++i) {
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", trajectory::stamp_text(part.value->at_ns[i]),
                     part.value->part.name, part.value->nees_per_dof[i]);
    }
  }
  return text;
}

Result<std::vector<NeesTableRow>> read_nees_table(const std::filesystem::path& file) {
  std::vector<NeesTableRow> rows;
  const Result<void> done =
      io::for_each_stamped_row(file, "capture_timestamp part nees_per_dof", io::TimeOrder::any,
                               [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
                                 NeesTableRow row{time_ns, std::string(table.text(1)), 0};
                                 if (auto read = table.numbers(2, {&row.nees_per_dof, 1}); !read) return read;
                                 rows.push_back(std::move(row));
                                 return {};
                               });
  if (!done) return tl::unexpected(done.error());
  return rows;
}

}  // namespace fusebench::run_files
