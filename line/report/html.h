#pragma once
#include <string>
#include <string_view>
namespace venato::line {
std::string html_escape(std::string_view text);  ///< & < > " '
std::string base64(std::string_view bytes);      ///< RFC 4648, padded
/// "data:image/png;base64,…" by the file's ending (png, svg, jpg). \throws UsageError when the file is missing or of another kind.
std::string data_uri(std::string_view file_name, std::string_view bytes);
/// Number for people: three significant digits, SI prefix by unit ("m" 0.0012 -> "1.2 mm"); "–" for NaN.
std::string pretty_number(double value, std::string_view unit);
extern const char* const kReportStyle;   ///< style sheet of the page
extern const char* const kReportScript;  ///< the slider; the page reads well without it
}  // namespace venato::line
