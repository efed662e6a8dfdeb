// SPDX-License-Identifier: MIT
#include "tool/run/flicker.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/run/progress.h"
#include "tb/scene/quality.h"
#include "tool/run/pictures.h"

namespace deburr::tool {
std::vector<Shorthand> sequence_shorthands() {
  return {{"--frames", "sequence.frames", "Measure flicker over N frames of a moving camera"},
          {"--motion", "sequence.motion", "zoom, roll (default) or pan"}};
}

int frames_of(const tb::ParameterSet& set, const tb::SequenceParameters& sequence,
              const tb::FrameLists& lists) {
  if (lists.frames() > 1) {
    const std::string why = fmt::format("{} lists {} frames", lists.longest(), lists.frames());
    for (const char* name : {"sequence.frames", "sequence.motion"}) set.reject(name, why);
    return lists.frames();
  }
  if (sequence.frames == 1) set.reject("sequence.motion", "sequence.frames = 1 has no motion");
  return sequence.frames;
}

namespace {

// A row of frames.csv; figures of an unknown reference are empty.
std::string row_of(int frame, const std::string& file, const SequencePicture& picture) {
  std::string row = fmt::format("{},{}", frame, file);
  tb::Quality quality;
  if (!picture.reference.empty())
    quality = measure_quality("", picture.before, picture.after, picture.reference, nullptr);
  for (const std::optional<double>& figure :
       {quality.psnr_db, quality.psnr_before_db, quality.psnr_edge_db, quality.psnr_edge_before_db,
        quality.flip, quality.flip_before, quality.ssim, quality.ssim_before})
    row += figure ? fmt::format(",{}", *figure) : ",";
  return row + "\n";
}

}  // namespace

void measure_flicker(int frames, RunContext& context, tb::Result& result,
                     const std::function<SequencePicture(int)>& picture) {
  tb::Progress progress("flicker", static_cast<std::uint64_t>(frames), "picture", context.quiet());
  tb::FlickerMeter after, before;
  bool reference = true;
  std::string first, last;  // files
  std::string rows =
      "frame,file,psnr_db,psnr_before_db,psnr_edge_db,psnr_edge_before_db,flip,flip_before,ssim,"
      "ssim_before\n";
  try {
    for (int i = 0; i < frames; ++i) {
      progress.update(static_cast<std::uint64_t>(i));
      SequencePicture now = picture(i);
      if (after.frames() > 0 &&
          (now.after.width != after.width() || now.after.height != after.height()))
        throw spec::ConfigError(
            fmt::format("frame {} has {} x {} pixels, the frames before it have {} x {}: flicker "
                        "is measured between frames of one size",
                        i, now.after.width, now.after.height, after.width(), after.height()));
      const tb::Mask drawn = now.drawn ? *now.drawn : tb::FlickerMeter::everywhere(now.after);
      reference = reference && !now.reference.empty();
      last = context.add_frame(i, now.after);
      if (i == 0) first = last;
      rows += row_of(i, last, now);
      if (now.reference.empty()) now.reference = now.before;
      after.add(std::move(now.after), now.reference, drawn);
      before.add(std::move(now.before), now.reference, drawn);
    }
  } catch (const tb::Interrupted&) {
    result.interrupted = true;
    return;
  }
  context.add_record("frames", "frames.csv", rows);
  add_flicker(result, after, before);
  result.terminal.push_back(
      {"flicker", fmt::format("{:.2f}/255 over {} frames{}, {}", after.mean(), frames,
                              after.worst() > 0 ? fmt::format(" (worst {:.2f}, at frame {})",
                                                              after.worst(), after.worst_frame())
                                                : "",
                              reference ? fmt::format("against {:.2f} of the input", before.mean())
                                        : "beyond that of the input")});
  if (!last.empty())
    result.terminal.push_back(
        {"frames", fmt::format("{} to {}, their quality in frames.csv", first, last)});
  result.figures.push_back({fmt::format("Flicker over {} frames{}", frames,
                                        reference ? "" : " beyond that of the input"),
                            "work.flicker", "largest between two successive frames",
                            "work.flicker_worst"});
  if (reference)
    result.figures.push_back(
        {"Flicker, compared with the input", "work.flicker", "input", "work.flicker_before"});
}

}  // namespace deburr::tool
