#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "base/h5/h5_file.h"
#include "line/products/operator.h"

namespace venato::line {
namespace {
constexpr const char* kType = "venato-operator";
constexpr int kVersion = 1;

std::vector<std::uint64_t> shape_of(const Operator& op) {
  return {static_cast<std::uint64_t>(op.nz_in), static_cast<std::uint64_t>(op.nz_out), static_cast<std::uint64_t>(op.n_theta),
          static_cast<std::uint64_t>(op.n_eta)};
}
bool is_file_name(const std::string& name) { return !name.empty() && name.find('/') == std::string::npos; }
}  // namespace

void write_operator(const std::filesystem::path& file, const Operator& op) {
  VENATO_EXPECTS(op.weight.size() == op.index(op.nz_in, 0, 0, 0) && op.replicates.size() == op.replicate_reference_delay_s.size());
  H5Writer h5(file, kType, kVersion);
  h5.attribute("/", "stage", op.stage);
  h5.attribute("/", "full_bed", op.full_bed ? 1.0 : 0.0);
  h5.dataset("/weight", std::span<const double>(op.weight), shape_of(op),
             {"1", "zeta_in,zeta_out,theta,eta", "belt", "share of the input layer's mass that lands in each cell of delay and lateral shift"});
  const std::vector<double> grid{op.theta0_s, op.dtheta_s, op.eta0_m, op.deta_m, op.reference_delay_s};
  h5.dataset("/grid", std::span<const double>(grid), {grid.size()},
             {"s,s,m,m,s", "theta0_s,dtheta_s,eta0_m,deta_m,reference_delay_s", "belt",
              "lower edge and width of the cells, and the delay theta counts from"});
  if (!op.replicates.empty()) {
    std::vector<double> all;
    all.reserve(op.replicates.size() * op.weight.size());
    for (const auto& replicate : op.replicates) {
      VENATO_EXPECTS(replicate.size() == op.weight.size());
      all.insert(all.end(), replicate.begin(), replicate.end());
    }
    std::vector<std::uint64_t> dims = shape_of(op);
    dims.insert(dims.begin(), op.replicates.size());
    h5.dataset("/replicates", std::span<const double>(all), dims,
               {"1", "replicate,zeta_in,zeta_out,theta,eta", "belt", "bootstrap replicates of weight"});
    h5.dataset("/replicate_reference_delay_s", std::span<const double>(op.replicate_reference_delay_s), {op.replicates.size()},
               {"s", "replicate", "belt", "reference delay of each replicate"});
  }
  if (!op.figures.empty()) {
    std::vector<std::string> names;
    std::vector<double> values;
    for (const auto& [name, value] : op.figures) names.push_back(name), values.push_back(value);
    h5.strings("/figures/name", names, {"1", "figure", "none", "what each value is; the name ends in its SI unit"});
    h5.dataset("/figures/value", std::span<const double>(values), {values.size()}, {"SI", "figure", "none", "figures that justify the operator"});
  }
  for (const auto& [curve, columns] : op.curves)
    for (const auto& [column, values] : columns) {
      VENATO_EXPECTS(is_file_name(curve) && is_file_name(column));
      if (values.empty()) continue;
      h5.dataset("/curves/" + curve + "/" + column, std::span<const double>(values), {values.size()},
                 {"SI", "sample", "none", "curve for the report; the name ends in its SI unit"});
    }
  if (!op.warnings.empty()) h5.strings("/warnings", op.warnings, {"1", "warning", "none", "what the user should know about this operator"});
  h5.strings("/provenance_json", {op.provenance_json}, {"1", "one", "none", "canonical inputs, seed and versions that made it"});
  h5.close();
}

Operator read_operator(const std::filesystem::path& file) {
  const H5Reader h5(file, kType, kVersion);
  Operator op;
  op.stage = h5.text_attribute("/", "stage");
  op.full_bed = h5.number_attribute("/", "full_bed") != 0;
  const auto dims = h5.dims("/weight");
  const auto grid = h5.doubles("/grid");
  const auto refuse = [&](const std::string& what) -> void {
    throw WorkError(file.string() + ": " + what + "; delete the file to characterise the stage again");
  };
  if (dims.size() != 4 || grid.size() != 5 || std::any_of(dims.begin(), dims.end(), [](std::uint64_t d) { return d == 0 || d > 1u << 24; }))
    refuse("weight or grid have the wrong shape");
  op.nz_in = static_cast<int>(dims[0]);
  op.nz_out = static_cast<int>(dims[1]);
  op.n_theta = static_cast<int>(dims[2]);
  op.n_eta = static_cast<int>(dims[3]);
  op.theta0_s = grid[0];
  op.dtheta_s = grid[1];
  op.eta0_m = grid[2];
  op.deta_m = grid[3];
  op.reference_delay_s = grid[4];
  op.weight = h5.doubles("/weight");
  if (h5.has("/replicates")) {
    const auto all = h5.doubles("/replicates");
    op.replicate_reference_delay_s = h5.doubles("/replicate_reference_delay_s");
    const std::size_t count = op.replicate_reference_delay_s.size(), size = op.weight.size();
    if (all.size() != count * size) refuse("replicates do not match their delays");
    for (std::size_t r = 0; r < count; ++r)
      op.replicates.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(r * size), all.begin() + static_cast<std::ptrdiff_t>((r + 1) * size));
  }
  if (h5.has("/figures/name")) {
    const auto names = h5.strings("/figures/name");
    const auto values = h5.doubles("/figures/value");
    if (names.size() != values.size()) refuse("figures have different numbers of names and values");
    for (std::size_t i = 0; i < names.size(); ++i) op.figures[names[i]] = values[i];
  }
  for (const std::string& name : h5.dataset_names()) {
    const std::string prefix = "/curves/";
    if (name.rfind(prefix, 0) != 0) continue;
    const auto slash = name.find('/', prefix.size());
    if (slash == std::string::npos) refuse("curve " + name + " has no column name");
    op.curves[name.substr(prefix.size(), slash - prefix.size())][name.substr(slash + 1)] = h5.doubles(name);
  }
  if (h5.has("/warnings")) op.warnings = h5.strings("/warnings");
  const auto provenance = h5.strings("/provenance_json");
  if (provenance.size() != 1) refuse("provenance is missing");
  op.provenance_json = provenance[0];
  return op;
}
}  // namespace venato::line
