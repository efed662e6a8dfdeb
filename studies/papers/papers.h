// SPDX-License-Identifier: MIT
// The reproduction report: for each figure printed in a paper, our computed value and a one-word
// verdict. One file per paper (papers_004.cpp, ...); this one prints the tables.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/papers/verdicts.h"
#include "tb/scene/image.h"

namespace deburr::tb {
class Waiting;
}  // namespace deburr::tb

namespace deburr::studies {

struct PaperTable {
  std::string title, note;
  // A column named "verdict" is shown as one (verdicts.h); "-": the row does not state a claim.
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct PaperImage {
  std::string file;  // without extension
  std::string title, caption;
  tb::Image image;
  bool wide = false;  // a sheet: shown over the whole width
};

struct PaperFigure {
  std::string title, note;
  std::vector<PaperImage> images;
};

struct Paper {
  std::string id, title, source;
  std::vector<PaperTable> tables;
  std::vector<PaperFigure> figures;
};

struct PaperOptions {
  bool quick = false;  // omits parts that take more than a few seconds
  int size = 512;      // side in pixels of the pictures and of the measured scenes
  bool quiet = false;  // no progress
  std::function<bool()> interrupted = [] { return false; };  // polled during the work

  // Throws Interrupted if requested: a partial paper is discarded.
  void go_on() const;
  // The same check for callees that poll by themselves; also shows the awaited item.
  std::function<bool()> watching(tb::Waiting& waiting) const;
};

// Builds one paper's tables; shows progress on the error stream. May throw Interrupted.
using PaperBuilder = Paper (*)(const PaperOptions&);
struct PaperEntry {
  const char* id;
  PaperBuilder build;
};
const std::vector<PaperEntry>& papers();

// A number for a table; "identical" for the infinite PSNR of identical pictures.
std::string decimals(double value, int digits);

// The tables as text, for the terminal.
std::string to_text(const Paper& paper);
// Writes papers.json, the pictures and index.html. Returns their description for the manifest.
nlohmann::ordered_json write_papers(const std::filesystem::path& directory,
                                    const std::vector<Paper>& papers);

namespace paper_000 {
Paper build(const PaperOptions& options);
}
namespace paper_002 {
Paper build(const PaperOptions& options);
}
namespace paper_003 {
Paper build(const PaperOptions& options);
}
namespace paper_004 {
Paper build(const PaperOptions& options);
}

}  // namespace deburr::studies
