# Writes the files ASSETS (separated by ,) as the C++ source OUTPUT, which
# defines FUNCTION of HEADER, a list of TYPE {name, text}:
#   cmake -DASSETS=a.js,b.css -DOUTPUT=assets.cc -DHEADER=app/report_assets.h
#         -DTYPE=ReportAsset -DFUNCTION=ReportAssets -P EmbedAssets.cmake
string(REPLACE "," ";" assets "${ASSETS}")
set(arrays "")
set(entries "")
set(number 0)
foreach(asset ${assets})
  get_filename_component(name ${asset} NAME)
  file(READ ${asset} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays
    "constexpr unsigned char kAsset${number}[] = {${bytes}0};\n")
  string(APPEND entries "      {\"${name}\", Text(kAsset${number})},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

#include <cstddef>

namespace hindsight {
namespace {

${arrays}
template <std::size_t N>
std::string_view Text(const unsigned char (&bytes)[N]) {
  return {reinterpret_cast<const char*>(bytes), N - 1};
}

}  // namespace

const std::vector<${TYPE}>& ${FUNCTION}() {
  static const std::vector<${TYPE}> assets = {
${entries}  };
  return assets;
}

}  // namespace hindsight
")
