#pragma once
/// An ICC output profile made up for tests: "synthetic, not a printer".
/// Ink k takes light of channel k % 3 (red, green, blue); inks of one channel are filled one after the other.
///   linear RGB, relative to the body = 1 - kDepth * (mean of the channel's inks)
#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>
namespace venato::graphics::test {

struct SyntheticProfile {
  int inks = 6, nodes_to_colour = 5, nodes_to_inks = 33;
  std::vector<std::string> names = {"Blue 1", "Brown", "Beige", "Yellow", "Pink", "Black"};  ///< empty = no colorant table
  bool to_inks = true, to_colour = true;
};
inline constexpr double kDepth = 0.94, kBodyLight = 0.8;
inline constexpr std::array<std::array<double, 3>, 3> kXyzOfRgb = {
    {{0.4360747, 0.3850649, 0.1430804}, {0.2225045, 0.7168786, 0.0606169}, {0.0139322, 0.0971045, 0.7141733}}};  // sRGB at D50
inline constexpr std::array<std::array<double, 3>, 3> kRgbOfXyz = {
    {{3.1338561, -1.6168667, -0.4906146}, {-0.9787684, 1.9161415, 0.0334540}, {0.0719453, -0.2289914, 1.4052427}}};

inline int inks_of_channel(int inks, int c) { return (inks - c + 2) / 3; }

inline cmsInt32Number ink_to_lab(const cmsUInt16Number in[], cmsUInt16Number out[], void* cargo) {
  const int inks = *static_cast<int*>(cargo);
  std::array<double, 3> rgb{1, 1, 1}, xyz{};
  for (int k = 0; k < inks; ++k) rgb[static_cast<std::size_t>(k % 3)] -= kDepth * in[k] / 65535.0 / inks_of_channel(inks, k % 3);
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) xyz[r] += kXyzOfRgb[r][c] * rgb[c];
  const cmsCIEXYZ colour{xyz[0], xyz[1], xyz[2]};
  cmsCIELab lab;
  cmsXYZ2Lab(nullptr, &lab, &colour);
  cmsFloat2LabEncoded(out, &lab);
  return TRUE;
}
inline cmsInt32Number lab_to_ink(const cmsUInt16Number in[], cmsUInt16Number out[], void* cargo) {
  const int inks = *static_cast<int*>(cargo);
  cmsCIELab lab;
  cmsCIEXYZ colour;
  cmsLabEncoded2Float(&lab, in);
  if (lab.L > 99.9 && std::abs(lab.a) < 16 && std::abs(lab.b) < 16) {  // a* = b* = 0 is no node: the nodes around white are clean, as makers do it
    std::fill_n(out, inks, cmsUInt16Number{0});
    return TRUE;
  }
  cmsLab2XYZ(nullptr, &colour, &lab);
  const std::array<double, 3> xyz{colour.X, colour.Y, colour.Z};
  for (int k = 0; k < inks; ++k) {
    const auto& row = kRgbOfXyz[static_cast<std::size_t>(k % 3)];
    const double rgb = row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2];
    const double fill = std::clamp((1 - rgb) / kDepth, 0.0, 1.0) * inks_of_channel(inks, k % 3) - k / 3;
    out[k] = static_cast<cmsUInt16Number>(std::lround(std::clamp(fill, 0.0, 1.0) * 65535));
  }
  return TRUE;
}
inline void add_table(cmsHPROFILE profile, cmsTagSignature tag, int in, int out, int nodes, cmsSAMPLER16 sampler, int inks) {
  cmsPipeline* table = cmsPipelineAlloc(nullptr, static_cast<cmsUInt32Number>(in), static_cast<cmsUInt32Number>(out));
  cmsStage* grid = cmsStageAllocCLut16bit(nullptr, static_cast<cmsUInt32Number>(nodes), static_cast<cmsUInt32Number>(in),
                                          static_cast<cmsUInt32Number>(out), nullptr);
  cmsStageSampleCLut16bit(grid, sampler, &inks, 0);
  cmsPipelineInsertStage(table, cmsAT_END, cmsStageAllocToneCurves(nullptr, static_cast<cmsUInt32Number>(in), nullptr));
  cmsPipelineInsertStage(table, cmsAT_END, grid);
  cmsPipelineInsertStage(table, cmsAT_END, cmsStageAllocToneCurves(nullptr, static_cast<cmsUInt32Number>(out), nullptr));
  cmsWriteTag(profile, tag, table);
  cmsPipelineFree(table);
}
inline void write_synthetic_profile(const std::filesystem::path& file, const SyntheticProfile& s = {}) {
  constexpr std::array<cmsColorSpaceSignature, 16> kSpaces = {cmsSigGrayData,    cmsSigGrayData,    cmsSig2colorData,  cmsSig3colorData,
                                                              cmsSigCmykData,    cmsSig5colorData,  cmsSig6colorData,  cmsSig7colorData,
                                                              cmsSig8colorData,  cmsSig9colorData,  cmsSig10colorData, cmsSig11colorData,
                                                              cmsSig12colorData, cmsSig13colorData, cmsSig14colorData, cmsSig15colorData};
  cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
  cmsSetProfileVersion(profile, 4.3);
  cmsSetDeviceClass(profile, cmsSigOutputClass);
  cmsSetColorSpace(profile, kSpaces.at(static_cast<std::size_t>(s.inks)));
  cmsSetPCS(profile, cmsSigLabData);
  cmsMLU* text = cmsMLUalloc(nullptr, 1);
  cmsMLUsetASCII(text, "en", "US", "synthetic, not a printer");
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
  cmsMLUfree(text);
  const cmsCIEXYZ* d50 = cmsD50_XYZ();
  const cmsCIEXYZ body{kBodyLight * d50->X, kBodyLight * d50->Y, kBodyLight * d50->Z};
  cmsWriteTag(profile, cmsSigMediaWhitePointTag, &body);
  if (s.inks == 1) {
    cmsToneCurve* curve = cmsBuildGamma(nullptr, 2.0);
    cmsWriteTag(profile, cmsSigGrayTRCTag, curve);
    cmsFreeToneCurve(curve);
  } else {
    if (s.to_colour) add_table(profile, cmsSigAToB0Tag, s.inks, 3, s.nodes_to_colour, ink_to_lab, s.inks);
    if (s.to_inks) add_table(profile, cmsSigBToA0Tag, 3, s.inks, s.nodes_to_inks, lab_to_ink, s.inks);
  }
  if (!s.names.empty()) {
    cmsNAMEDCOLORLIST* inks = cmsAllocNamedColorList(nullptr, static_cast<cmsUInt32Number>(s.names.size()), 3, "", "");
    for (const auto& name : s.names) {
      cmsUInt16Number pcs[3] = {0, 0, 0};
      cmsAppendNamedColor(inks, name.c_str(), pcs, nullptr);
    }
    cmsWriteTag(profile, cmsSigColorantTableTag, inks);
    cmsFreeNamedColorList(inks);
  }
  cmsSaveProfileToFile(profile, file.c_str());
  cmsCloseProfile(profile);
}
}  // namespace venato::graphics::test
