#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/io/atomic_file.h"
#include "graphics/draw/figure.h"
#include "graphics/graphic.h"
#include "graphics/raster/resample.h"
#include "line/chain/run_line.h"
#include "line/press_map/sample_slab.h"
#include "line/report/curve_plots.h"
#include "sync/overlay/overlay.h"
namespace venato::line {
namespace {
constexpr int kPictureWidth = 1000;  // px: sharp on a laptop screen, small enough for one page with all pictures inside
constexpr double kSectionScale = 6;  // depth is drawn this much larger, else a 13 mm slab is a hair line
constexpr int kPlotWidth = 640, kPlotHeight = 340;

class Book {
 public:
  Book(const std::filesystem::path& folder, LineRun& run) : folder_(folder / "figures"), run_(run) { std::filesystem::create_directories(folder_); }
  void picture(const std::string& name, const std::string& section, const std::string& title, const std::string& caption,
               const graphics::Raster8& image) {
    graphics::write_png(folder_ / (name + ".png"), graphics::shrink_to_width(image, kPictureWidth));
    run_.figures.push_back({"figures/" + name + ".png", section, title, caption});
  }
  void plot(const std::string& name, const std::string& section, const std::string& caption, const Plot& plot) {
    write_text_atomically(folder_ / (name + ".svg"), svg_plot(plot, kPlotWidth, kPlotHeight));
    run_.figures.push_back({"figures/" + name + ".svg", section, plot.title, caption});
  }

 private:
  std::filesystem::path folder_;
  LineRun& run_;
};

std::string text(const char* format, double a, double b = 0, double c = 0) {
  char out[300];
  std::snprintf(out, sizeof out, format, a, b, c);
  return out;
}

std::string slug(std::string s) {
  for (char& c : s)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return s;
}

graphics::Raster8 rgb(const graphics::Raster8& p) {
  if (p.channels == 3) return p;
  graphics::Raster8 out(p.width, p.height, 3, p.pitch_m);
  for (std::size_t k = 0; k < p.data.size(); ++k) std::fill_n(out.data.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, p.data[k]);
  return out;
}

void heat(Book& book, const std::string& name, const std::string& title, const graphics::RasterF& raster, double unit, const std::string& label,
          const std::string& caption) {
  if (raster.empty()) return;
  graphics::RasterF shown = raster;
  for (auto& v : shown.data) v = static_cast<float>(static_cast<double>(v) * unit);
  graphics::MapStyle style;
  style.label = label;
  book.picture(name, "slab", title, caption, graphics::draw_map(shown, style));
}

/// Cut through the slab between two green points, depth enlarged.
graphics::Raster8 cut_picture(const LineConfig& c, const Slab& slab, double x0, double y0, double x1, double y1) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  const double thickness = sample_bilinear(slab.thickness_m, (x0 + x1) / 2, (y0 + y1) / 2, 0);
  const auto section = sample_section(slab, x0, y0, x1, y1, c.basics.grid.pitch_m);
  graphics::RasterF upright(section.width, section.height, section.channels, section.pitch_m);  // draw_section wants the bottom face first
  for (int j = 0; j < section.height; ++j)
    for (int i = 0; i < section.width; ++i)
      for (int k = 0; k < section.channels; ++k) upright.at(i, j, k) = section.at(i, section.height - 1 - j, k);
  std::vector<graphics::Srgb8> colours;
  std::vector<std::string> names;
  for (const auto& p : c.basics.powders) colours.push_back(p.colour), names.push_back(p.name);
  return graphics::draw_section(upright, colours, names, length, thickness, kSectionScale, "");
}

void stage_figures(Book& book, const LineRun& run) {
  for (std::size_t s = 0; s < run.operators.size(); ++s) {
    const auto& op = run.operators[s].op;
    const std::string stage = run.chain.stages[s].name;
    for (const auto& [curve, columns] : op.curves) {
      int k = 0;
      for (const auto& plot : plots_of_curve(curve, columns))
        book.plot(stage + "_" + slug(curve) + (k == 0 ? std::string() : std::string("_").append(std::to_string(k + 1))), stage,
                  "From the particle simulation of the stage's slice.", plot),
            ++k;
    }
    int k = 0;
    for (const auto& plot : plots_of_kernel(op))
      book.plot(stage + "_kernel_" + std::to_string(++k), stage,
                "What the stage does to a sharp edge: a wide kernel blurs it, a lopsided one also moves it.", plot);
  }
}
}  // namespace

void write_figures(const std::filesystem::path& run_folder, const LineConfig& c, LineRun& run, const graphics::Raster8& design,
                   const graphics::Raster8& print_srgb) {
  Book book(run_folder, run);
  graphics::VeinMap planned;
  planned.powders = run.plan.powders;
  for (const auto& p : c.basics.powders) planned.colours.push_back(p.colour);
  planned.fraction = run.plan.fraction;
  planned.body_powder = run.plan.body_powder;
  book.picture("design", "asked", "Design", "The picture whose veins shall go through the body, cut to the slab.", rgb(design));
  book.picture("plan", "asked", "Plan for the dosing heads",
               "Where the picture asks for vein powder: veins are simplified and widened to what a prong can lay.",
               graphics::colour_preview(planned));
  book.picture("graphic", "asked", "Inkjet graphic", "As it would be printed without synchronisation.", print_srgb);

  const double depth_mm = c.vein_map.polish_depth_m * 1e3;
  book.picture("vein_map", "slab", "Predicted vein map",
               depth_mm > 0
                   ? text("The pressed slab %.2f mm below its face. Compare the vein edges with the plan: they are softer, and moved.", depth_mm)
                   : std::string("The face of the pressed slab. Compare the vein edges with the plan: they are softer, and moved."),
               graphics::colour_preview(run.vein_map));
  heat(book, "std_error", "Standard error of the vein share", run.vein_map.std_error, 100, "standard error [%]",
       "How far the vein share of a point can be trusted, from bootstrap replicates of the operators: it is largest along vein edges.");
  const auto size = green_size(c.basics);
  const double edge = c.basics.grid.pitch_m;  // cuts stay inside the slab
  book.picture(
      "section_along", "slab", "Cut along the belt",
      text("Middle of the slab, face on top, depth drawn %.0f times larger. A vein that leans shows that transport sheared the bed.", kSectionScale),
      cut_picture(c, run.slab(), size.width_m / 2, edge, size.width_m / 2, size.length_m - edge));
  book.picture("section_across", "slab", "Cut across the belt",
               text("Middle of the slab, face on top, depth drawn %.0f times larger.", kSectionScale),
               cut_picture(c, run.slab(), edge, size.length_m / 2, size.width_m - edge, size.length_m / 2));
  heat(book, "thickness", "Pressed thickness", run.slab().thickness_m, 1e3, "thickness [mm]",
       "Even colour is good; bands come from uneven deposition.");
  heat(book, "density", "Pressed density", run.slab().density_kg_m3, 1, "density [kg/m3]",
       "0.01 g/cm³ changes the firing shrinkage by about 0.16 %.");

  const auto& s = run.sync;
  book.picture("overlay_before", "sync", "Before synchronisation",
               "Body veins blue, print veins orange, both dark. Orange beside blue is a vein that the eye sees twice.",
               sync::overlay_panel(s.body, s.print_before));
  book.picture("overlay_after", "sync", "After synchronisation", "The same with the print moved onto the body's veins.",
               sync::overlay_panel(s.body, s.print_after));
  book.picture("overlay_best", "sync", "Best reachable",
               "The print moved by the simulation's own displacement: what is left comes from blur and from the plan's simplification, no "
               "registration can remove it.",
               sync::overlay_panel(s.body, s.print_best));
  book.picture("misfit_before", "sync", "Misfit before",
               "Centre lines of the print's veins, coloured by their distance to the body's vein; magenta has no partner in reach.",
               sync::misfit_figure(s.body, s.residuals_before));
  book.picture("misfit_after", "sync", "Misfit after", "Same colours. What stays bright or magenta is where to look first.",
               sync::misfit_figure(s.body, s.residuals_after));
  if (s.visibility)
    book.picture("visibility", "sync",
                 s.visibility->after.empty() ? "What the eye sees of the misfit before" : "What the eye sees of the misfit after",
                 "Body veins and print veins in the same two colours, compared as an eye at 0.5, 1 and 2 m sees them; 2.3 is just noticeable.",
                 sync::visibility_figure(s.visibility->after.empty() ? s.visibility->before : s.visibility->after));
  book.plot("residuals", "sync",
            "Further left and higher is better; the distance between the curves of after and best reachable is what a better registration could "
            "still gain.",
            residual_plot({{"before", s.residuals_before}, {"after", s.residuals_after}, {"best reachable", s.residuals_best}}));
  stage_figures(book, run);
}
}  // namespace venato::line
