# Writes OUT, a C++ source with the files JS and CSS as raw string literals:
#   cmake -DJS=viewer.js -DCSS=viewer.css -DOUT=viewer_bundle.cpp -P embed.cmake
file(READ "${JS}" js)
file(READ "${CSS}" css)
file(WRITE "${OUT}" "#include \"easydyn/visu/viewer_bundle.hpp\"

namespace easydyn::visu {

const std::string_view viewer_js = R\"=====(${js})=====\";

const std::string_view viewer_css = R\"=====(${css})=====\";

}  // namespace easydyn::visu
")
