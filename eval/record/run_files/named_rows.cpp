#include "eval/record/run_files/named_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::run_files {

namespace {

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const bool quoted = begin < line.size() && line[begin] == '"';
    const std::size_t close = quoted ? line.find('"', begin + 1) : std::string_view::npos;
    const std::size_t end =
        std::min(line.find(',', close == std::string_view::npos ? begin : close), line.size());
    const bool whole = close != std::string_view::npos && close + 1 == end;
    cells.push_back(whole ? line.substr(begin + 1, close - begin - 1) : line.substr(begin, end - begin));
    begin = end + 1;
  }
}

}  // namespace

Result<std::string_view> NamedRow::text(std::string_view name) const {
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) return fail(ErrorCode::data_corrupt, fmt::format("has no column {}", name));
  return cells_[static_cast<std::size_t>(found - names_.begin())];
}

Result<std::optional<double>> NamedRow::number(std::string_view name) const {
  const auto cell = text(name);
  if (!cell) return tl::unexpected(cell.error());
  if (cell->empty()) return std::nullopt;
  return io::parse_number(*cell).transform([](double value) { return std::optional(value); });
}

Result<std::int64_t> NamedRow::time_ns(std::string_view name) const {
  return text(name).and_then([](std::string_view cell) { return io::parse_time_ns(cell); });
}

Result<void> for_each_named_row(const std::filesystem::path& file,
                                const std::function<Result<void>(const NamedRow&)>& row) {
  std::ifstream stream = io::input_file(file);
  std::string line;
  if (!stream || !io::next_line(stream, line))
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read", file.string()));
  std::vector<std::string_view> cells;
  split_cells(line, cells);
  const std::vector<std::string> names(cells.begin(), cells.end());
  for (std::size_t number = 2; io::next_line(stream, line); ++number) {
    const auto refuse = [&](std::string_view what) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: {}", file.string(), number, what));
    };
    split_cells(line, cells);
    if (cells.size() != names.size())
      return refuse(fmt::format("{} cells (expected {})", cells.size(), names.size()));
    if (auto read = row(NamedRow(names, cells)); !read) return refuse(read.error().message);
  }
  return {};
}

}  // namespace fusebench::run_files
