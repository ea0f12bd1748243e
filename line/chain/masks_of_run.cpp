#include "line/chain/masks_of_run.h"
namespace venato::line {

void write_masks_of_run(const std::filesystem::path& run, const std::filesystem::path& out, std::optional<double> dpi, const MaskChoices& choices,
                        Context& context, const std::vector<StageDescriptor>& stages) {
  const auto source = read_run_source(run);
  auto config = load_line_config_text(source.config_json, source.config_file.parent_path(), {}, stages);
  config.file = source.config_file;
  if (dpi) config.graphic.print_dpi = *dpi;
  context.seed = config.basics.seed;
  const auto parts = read_run_for_masks(run, config);
  if (!parts.sync.registration.success)
    context.log.warn("the registration of this run did not succeed: the print files are as designed, not synchronised");
  write_mask_files(out, config, parts, load_graphic(config, context.threads), choices, context);
}
}  // namespace venato::line
