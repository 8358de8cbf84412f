// Files that every page carries within itself. Defined by a generated source (cmake/embed_files.cmake).
#pragma once

#include <string_view>

namespace fusebench {

[[nodiscard]] std::string_view page_style();     ///< eval/report/page.css
[[nodiscard]] std::string_view page_script();    ///< eval/report/page.js
[[nodiscard]] std::string_view chart_library();  ///< Chart.js (MIT), with its notice

}  // namespace fusebench
