// Files that every page carries within itself. Defined by a generated source
// (scripts/cmake/embed_files.cmake).
#pragma once

#include <string_view>

namespace fusebench::page {

[[nodiscard]] std::string_view page_style();            ///< eval/page/page.css
[[nodiscard]] std::string_view chart_axes_script();     ///< eval/page/chart_axes.js
[[nodiscard]] std::string_view chart_plugins_script();  ///< eval/page/chart_plugins.js
[[nodiscard]] std::string_view page_script();           ///< eval/page/page.js
[[nodiscard]] std::string_view timeline_script();       ///< eval/page/timeline.js
[[nodiscard]] std::string_view zoom_script();           ///< eval/page/zoom.js
[[nodiscard]] std::string_view chart_library();         ///< Chart.js (MIT), with its notice

// Of pages with meshes.
[[nodiscard]] std::string_view scene_camera_script();  ///< eval/page/scene_camera.js
[[nodiscard]] std::string_view scene_script();         ///< eval/page/scene.js
[[nodiscard]] std::string_view scene_library();        ///< three.js (MIT), with its notice
[[nodiscard]] std::string_view scene_controls();       ///< its OrbitControls

}  // namespace fusebench::page
