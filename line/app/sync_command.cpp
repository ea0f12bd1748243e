#include "sync/command/sync_command.h"

#include "base/units.h"
#include "line/app/commands.h"
namespace venato::line::app {

int sync_command(const Options& o, Context& context) {
  sync::SyncOptions options;
  options.vein_map = o.vein_map;
  options.camera = o.camera;
  options.graphic = o.graphic;
  if (o.vein_pitch_mm > 0) options.vein_pitch_m = o.vein_pitch_mm * 1e-3;
  if (o.graphic_pitch_mm > 0) options.graphic_pitch_m = o.graphic_pitch_mm * 1e-3;
  options.registration.allow_half_turn = o.turns == "half";
  options.registration.allow_quarter_turns = o.turns == "quarter";
  options.registration.allow_flip = o.mirrored;
  options.registration.max_rotation_rad = o.max_rotation_deg * si_factor("deg");
  options.out = o.out;
  return sync::run_sync(options, context);
}
}  // namespace venato::line::app
