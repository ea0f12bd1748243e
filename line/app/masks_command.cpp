#include <map>

#include "line/app/commands.h"
#include "line/chain/masks_of_run.h"
namespace venato::line::app {
namespace {
const std::map<std::string, graphics::TiffCompression> kCompression{{"none", graphics::TiffCompression::none},
                                                                    {"packbits", graphics::TiffCompression::packbits},
                                                                    {"lzw", graphics::TiffCompression::lzw},
                                                                    {"deflate", graphics::TiffCompression::deflate}};
sync::Polarity polarity(const std::string& text) {
  return text == "zero-is-full-ink" ? sync::Polarity::zero_is_full_ink : sync::Polarity::zero_is_no_ink;
}
}  // namespace

int masks_command(const Options& o, Context& context) {
  MaskChoices choices;
  choices.compression = kCompression.at(o.compression);
  choices.print_polarity = polarity(o.print_polarity);
  choices.ink_file_polarity = polarity(o.ink_polarity);
  choices.powders_at_print_resolution = o.powders_at_print_resolution;
  write_masks_of_run(o.input, o.out, o.dpi > 0 ? std::optional(o.dpi) : std::nullopt, choices, context);
  context.log.info("printer files: " + (o.out / "masks.json").string());
  return 0;
}
}  // namespace venato::line::app
