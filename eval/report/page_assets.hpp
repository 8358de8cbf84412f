// Files that every page carries within itself. Defined by a generated source (cmake/embed_files.cmake).
#pragma once

#include <string_view>

namespace fusebench {

[[nodiscard]] std::string_view page_style();     ///< eval/report/page.css
[[nodiscard]] std::string_view page_script();    ///< eval/report/page.js
[[nodiscard]] std::string_view chart_library();  ///< Chart.js (MIT), with its notice

// Of pages with meshes.
[[nodiscard]] std::string_view scene_script();    ///< eval/report/scene.js
[[nodiscard]] std::string_view scene_library();   ///< three.js (MIT), with its notice
[[nodiscard]] std::string_view scene_controls();  ///< its OrbitControls

}  // namespace fusebench
