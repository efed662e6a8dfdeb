// SPDX-License-Identifier: MIT
#include "golden/geometric/geometric_golden.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "golden/geometric/line.h"
#include "golden/geometric/resolve.h"
#include "spec/error.h"
#include "spec/geometric/check_build.h"
#include "spec/poll.h"

namespace deburr::golden::geometric {
namespace {

using spec::geometric::Axis;
using spec::geometric::BlockRecord;
using spec::geometric::Candidate;
using spec::geometric::Direction;
using spec::geometric::Edge;
using spec::geometric::EdgeClass;
using spec::geometric::LineRecord;
using spec::geometric::Region;
using spec::geometric::Rgba8;
using spec::geometric::Vertex;
using spec::geometric::Weights;

template <class Pixel>
void check_view(const morphological::ViewOf<Pixel>& view, int width, int height, const char* what) {
  const auto w = static_cast<std::size_t>(view.width), h = static_cast<std::size_t>(view.height);
  DEBURR_CHECK(view.width == width && view.height == height && view.stride >= w &&
                   view.pixels.size() >= (h - 1) * view.stride + w,
               std::string(what) + " of " + std::to_string(view.width) + " x " +
                   std::to_string(view.height) + " pixels, stride " + std::to_string(view.stride) +
                   ", in a span of " + std::to_string(view.pixels.size()) + " for a frame of " +
                   std::to_string(width) + " x " + std::to_string(height));
}

// Lines that a block needs (a handful), ordered by v, then u.
class LineSet {
 public:
  void add(const LineOfPixels& line) {
    const auto less = [](const LineOfPixels& a, const LineOfPixels& b) {
      return a.v != b.v ? a.v < b.v : a.u < b.u;
    };
    LineOfPixels* const where = std::lower_bound(begin(), end(), line, less);
    if (where != end() && *where == line) return;
    std::copy_backward(where, end(), end() + 1);
    *where = line;
    ++size_;
  }
  LineOfPixels* begin() { return lines_.data(); }
  LineOfPixels* end() { return lines_.data() + size_; }
  std::size_t size() const { return size_; }

 private:
  std::array<LineOfPixels, EdgeCoverage::kMaxBlockLines> lines_;
  std::size_t size_ = 0;
};

int cache_bits(spec::geometric::CacheLines lines) {
  return spec::geometric::kCacheLineBits[static_cast<std::size_t>(lines)];
}

}  // namespace

GeometricGolden::GeometricGolden(const spec::geometric::Parameters& parameters, Detail detail)
    : parameters_(parameters), everything_(detail == Detail::kEverything) {
  check_build(parameters);
  split_ = parameters.records == spec::geometric::RecordsLayout::kSplit;
  lanes_ = spec::geometric::kLaneCount[static_cast<std::size_t>(parameters.walkers)];
}

const std::vector<Rgba8>& GeometricGolden::process(const FrameInput& input) {
  start(input);
  for (const Edge& edge : input_.edges) {
    spec::poll();
    draw_edge(edge);
  }
  if (follow_) empty_write_buffer();
  for (int by = 0; by < layout_.block_rows(); ++by) {
    spec::poll();
    const std::uint8_t* row = touched_.data() + std::ptrdiff_t{by} * layout_.block_columns();
    for (int bx = 0; bx < layout_.block_columns(); ++bx) {
      if (row[bx] != 0) resolve_block(bx, by);
    }
  }
  if (follow_) finish_traffic();
  return pixels_;
}

void GeometricGolden::start(const FrameInput& input) {
  const std::uint32_t boundaries = !split_                ? 0
                                   : input.boundary_count ? *input.boundary_count
                                                          : count_boundaries(input.edges);
  check_frame(parameters_, {input.image.width, input.image.height, input.edges.size(),
                            input.vertices.size(), input.facing.count, boundaries});
  input_ = input;
  width_ = input.image.width;
  height_ = input.image.height;
  check_view(input.image, width_, height_, "an image");
  if (parameters_.depth_test != spec::geometric::DepthTest::kOff)
    check_view(input.depth, width_, height_, "depth");
  DEBURR_CHECK(input.facing.bytes.size() >= (std::size_t{input.facing.count} + 7) / 8,
               "facing bits of " + std::to_string(input.facing.count) + " faces in " +
                   std::to_string(input.facing.bytes.size()) + " bytes");
  coarse_layout_ = CoarseLayout(width_, height_);
  DEBURR_CHECK(input.coarse.empty() || input.coarse.size() == coarse_layout_.tiles(),
               std::to_string(input.coarse.size()) + " entries of coarse depth for " +
                   std::to_string(coarse_layout_.tiles()) + " tiles");
  check_bases();
  work_ = {};
  traffic_.clear();
  classes_.clear();
  lines_.clear();
  candidates_.clear();
  blocks_.clear();
  memory_errors_ = 0;
  follow_ = everything_ || error_ != nullptr;
  layout_ = FrameLayout(parameters_.layout, width_, height_);
  const auto blocks = static_cast<std::size_t>(layout_.block_columns()) *
                      static_cast<std::size_t>(layout_.block_rows());
  touched_.assign(blocks, 0);
  weights_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), {});
  if (split_) pairs_ = split_pairs(input.edges, boundaries, input.bases);
  // Entries derived from the depth buffer drop no visible candidate, so pixels do not need them.
  screen_ = parameters_.coarse_lines != spec::geometric::CoarseLines::kNone &&
            (follow_ || !input.coarse.empty());
  if (screen_ && input.coarse.empty()) {
    coarse_ = coarse_entries(input.depth);
  } else if (screen_) {
    coarse_.assign(input.coarse.begin(), input.coarse.end());
  }
  if (follow_) start_traffic();
  pixels_.resize(weights_.size());
  for (int y = 0; y < height_; ++y) {
    std::copy_n(input.image.row(y), width_,
                pixels_.begin() + static_cast<std::ptrdiff_t>(y) * width_);
  }
  if (error_) read_with_errors();
}

void GeometricGolden::check_bases() const {
  const Bases& b = input_.bases;
  for (const std::uint32_t base : {b.edges, b.vertices, b.facing, b.depth, b.colour, b.weights,
                                   b.copy, b.pairs, b.coarse, b.other_pairs.value_or(0)}) {
    DEBURR_CHECK(base % spec::geometric::kLineBytes == 0,
                 "base address " + std::to_string(base) + " is not a multiple of 64");
  }
}

void GeometricGolden::start_traffic() {
  vertex_cache_.reset(cache_bits(parameters_.vertex_lines), cache_bits(parameters_.vertex_lines));
  const int depth_bits = cache_bits(parameters_.depth_lines);
  depth_cache_.reset(depth_bits, depth_column_bits(parameters_.layout, depth_bits));
  const int block_bits = cache_bits(parameters_.weight_blocks);
  block_cache_.reset(block_bits, block_column_bits(block_bits));
  write_buffer_.reset(parameters_.write_buffer);
  if (screen_) {
    const int bits = std::countr_zero(
        spec::geometric::kCoarseLineCount[static_cast<std::size_t>(parameters_.coarse_lines)]);
    coarse_cache_.reset(bits, block_column_bits(bits));
  }
  if (parameters_.colour_lines > 0)
    kept_colours_.reset(layout_.bytes() / spec::geometric::kLineBytes, parameters_.colour_lines);
}

// A line that memory cannot read is all zeros.
void GeometricGolden::read_with_errors() {
  const Bases& bases = input_.bases;
  constexpr std::uint32_t kLine = spec::geometric::kLineBytes;
  const auto record = [](std::size_t i, std::size_t in_line) {
    return static_cast<std::uint32_t>(i / in_line) * kLine;
  };
  read_edges_.assign(input_.edges.begin(), input_.edges.end());
  for (std::size_t i = 0; i < read_edges_.size(); ++i)
    if (bad(bases.edges + record(i, edges_in_line()))) read_edges_[i] = {};
  read_vertices_.assign(input_.vertices.begin(), input_.vertices.end());
  for (std::size_t i = 0; i < read_vertices_.size(); ++i)
    if (bad(bases.vertices + record(i, spec::geometric::kVerticesInLine))) read_vertices_[i] = {};
  read_facing_.assign(input_.facing.bytes.begin(), input_.facing.bytes.end());
  for (std::size_t i = 0; i < read_facing_.size(); ++i)
    if (bad(bases.facing + record(i, kLine))) read_facing_[i] = 0;
  read_depth_.assign(weights_.size(), 0);
  read_image_ = pixels_;
  for (int y = 0; y < height_; ++y) {
    spec::poll();
    for (int x = 0; x < width_; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x);
      const std::uint32_t line = layout_.offset_of(layout_.line_of(x, y));
      if (!input_.depth.empty() && !bad(bases.depth + line)) read_depth_[i] = input_.depth.at(x, y);
      if (bad(bases.colour + line) || (parameters_.frame_copy && bad(bases.copy + line)))
        read_image_[i] = {};
    }
  }
  for (std::uint32_t ty = 0, i = 0; screen_ && i < coarse_.size(); ++ty)
    for (std::uint32_t tx = 0; tx < coarse_layout_.columns(); ++tx, ++i)
      if (bad(bases.coarse + coarse_layout_.offset_of(CoarseLayout::line_of({tx, ty}))))
        coarse_[i] = 0;
  input_.edges = read_edges_;
  input_.vertices = read_vertices_;
  input_.facing.bytes = read_facing_;
  input_.depth = {read_depth_, width_, height_};
  input_.image = {read_image_, width_, height_};
}

void GeometricGolden::draw_edge(const Edge& edge) {
  ++work_.edges;
  const auto vertices = static_cast<std::uint32_t>(input_.vertices.size());
  const EdgeClass c = split_ ? classify_faces(parameters_, edge, input_.facing)
                             : classify(parameters_, edge, vertices, input_.facing);
  count_class(edge, c);
  Pair pair{edge.v0, edge.v1};
  bool kept = is_kept(c);
  if (split_) {
    const std::size_t array = array_of(edge.flags);
    const std::uint32_t number = pairs_[array].next++;
    const bool invalid = kept && !fetch_pair(array, number, pair);
    if (invalid) ++work_.invalid_edges;
    kept = kept && !invalid;
  }
  if (everything_) classes_.push_back(kept || !is_kept(c) ? c : EdgeClass::kInvalid);
  if (!kept) return;
  ++work_.kept_edges;
  if (follow_) fetch_vertices(pair);
  const Vertex &p = input_.vertices[pair.v0], &q = input_.vertices[pair.v1];
  LineRecord line;
  const LineFate fate = set_up_line(p, q, width_, height_, line);
  if (everything_) coverage_.count_fate(fate);
  switch (fate) {
    case LineFate::kOutside:
      ++work_.outside_edges;
      return;
    case LineFate::kDegenerate:
      ++work_.degenerate_edges;
      return;
    case LineFate::kEmptyColumns:
    case LineFate::kEmptyBefore:
    case LineFate::kEmptyAfter:
      ++work_.empty_edges;
      return;
    case LineFate::kLine:
      break;
  }
  line.crease = c == EdgeClass::kCrease;
  ++work_.lines;
  work_.columns += line.count;
  if (everything_) {
    lines_.push_back(line);
    coverage_.count_line(p, q, width_, height_);
  }
  if (follow_) {
    walk<true>(line);
  } else {
    walk<false>(line);
  }
}

void GeometricGolden::count_class(const Edge& edge, EdgeClass c) {
  switch (c) {
    case EdgeClass::kInvalid:
      ++work_.invalid_edges;
      break;
    case EdgeClass::kBoundary:
      ++work_.boundary_edges;
      break;
    case EdgeClass::kSilhouette:
      ++work_.silhouette_edges;
      break;
    case EdgeClass::kBack:
      ++work_.back_edges;
      break;
    case EdgeClass::kCrease:
      ++work_.crease_edges;
      break;
    case EdgeClass::kFlat:
      ++work_.flat_edges;
      break;
    case EdgeClass::kUnclassified:
      break;
  }
  if (everything_) {
    coverage_.count_class(parameters_, c);
    const bool two_faces =
        parameters_.select == spec::geometric::Select::kEdges &&
        (c == EdgeClass::kBack || c == EdgeClass::kCrease || c == EdgeClass::kFlat);
    if (two_faces && !input_.facing.at(edge.f0)) coverage_.count_turned_away(parameters_.cull, c);
  }
}

// Returns false if the pair number or a vertex index is out of range.
bool GeometricGolden::fetch_pair(std::size_t array, std::uint32_t number, Pair& pair) {
  PairArray& from = pairs_[array];
  const auto count = [&](PairFetch outcome) {
    if (everything_) coverage_.count_pair(outcome);
  };
  if (number >= from.count) {
    count(PairFetch::kInvalidNumber);
    return false;
  }
  const std::uint32_t line = number / std::uint32_t{spec::geometric::kSplitInLine};
  const std::uint32_t address = from.base + line * spec::geometric::kLineBytes;
  const bool hit = line == from.last_line;
  if (follow_ && !hit) traffic_.read(Region::kPairs).push_back(address);
  from.last_line = line;
  count(array == 0 ? (hit ? PairFetch::kBoundaryHit : PairFetch::kBoundaryMiss)
                   : (hit ? PairFetch::kOtherHit : PairFetch::kOtherMiss));
  // An entry beyond the array (if registers, flags and memory disagree) was never written: zeros.
  pair = bad(address) || number >= from.pairs.size() ? Pair{} : from.pairs[number];
  const auto vertices = static_cast<std::uint32_t>(input_.vertices.size());
  if (are_vertices_there(pair.v0, pair.v1, vertices)) return true;
  count(PairFetch::kInvalidVertex);
  return false;
}

void GeometricGolden::fetch_vertices(const Pair& pair) {
  const auto fetch = [&](std::uint32_t line) {
    std::uint64_t replaced = 0;
    const bool hit = vertex_cache_.look_up(line, 0, replaced);
    if (!hit) {
      traffic_.read(Region::kVertices)
          .push_back(input_.bases.vertices + line * spec::geometric::kLineBytes);
    }
    count_fetch(CacheKind::kVertex, hit                                  ? Fetch::kHit
                                    : replaced == DirectMapped::kNothing ? Fetch::kMiss
                                                                         : Fetch::kReplaced);
  };
  const std::uint32_t first = pair.v0 / spec::geometric::kVerticesInLine;
  const std::uint32_t second = pair.v1 / spec::geometric::kVerticesInLine;
  fetch(first);
  if (second != first) fetch(second);
}

template <bool kFollow>
void GeometricGolden::walk(const LineRecord& line) {
  const bool horizontal = line.axis == Axis::kHorizontal;
  const int rows = horizontal ? height_ : width_;
  const bool test = parameters_.depth_test != spec::geometric::DepthTest::kOff;
  std::int64_t position = line.position, depth = line.depth;
  int group_block = 0, group_size = 0;  // row of blocks; columns
  const int end = line.first + line.count;
  for (int c = line.first; c < end; ++c, position += line.slope, depth += line.depth_step) {
    const ColumnPoint at = point_at(position, depth);
    const int block = at.row >> 2;
    if (group_size == 0 || group_size == lanes_ || (c & 3) == 0 || block != group_block) {
      if (kFollow && everything_ && group_size != 0) {
        coverage_.count_group(group_size == lanes_ ? GroupEnd::kLength
                              : (c & 3) == 0       ? GroupEnd::kAlong
                                                   : GroupEnd::kAcross);
      }
      ++work_.groups;
      group_size = 0;
      group_block = block;
    }
    ++group_size;
    if (static_cast<unsigned>(at.row) >= static_cast<unsigned>(rows)) continue;
    const Shares cut = shares(parameters_.coverage, at.distance, line.slope);
    if (cut.first == 0) continue;
    const bool forward = is_forward(at.distance, line.tie_forward);
    const Direction to = direction(line.axis, forward);
    const int neighbour = at.row + (forward ? 1 : -1);
    if (static_cast<unsigned>(neighbour) >= static_cast<unsigned>(rows)) {
      if (kFollow && everything_) coverage_.count_outside(to);
      continue;
    }
    const int x = horizontal ? c : at.row, y = horizontal ? at.row : c;
    const int nx = horizontal ? c : neighbour, ny = horizontal ? neighbour : c;
    std::uint32_t own = 0, other = 0;
    bool passed = true;
    if (test && screen_ && is_dropped_early<kFollow>(x, y, nx, ny, to, at.depth)) {
      passed = false;
    } else if (test) {
      own = input_.depth.at(x, y) & 0xFFFFFF;
      other = input_.depth.at(nx, ny) & 0xFFFFFF;
      passed = passes(parameters_, line.crease, at.depth, own, other);
      if (kFollow) {
        fetch_depth(x, y, nx, ny);
        if (everything_) count_test(line, to, at.depth, own, other);
      }
    }
    if (kFollow && everything_ && at.distance == 0) coverage_.count_tie(line);
    add_candidate<kFollow>(x, y, to, cut.first, at.depth, passed,
                           is_nearer(parameters_, own, other));
    if (cut.second == 0) continue;
    if (kFollow && everything_) coverage_.count_second(opposite(to), neighbour >> 2 != block);
    add_candidate<kFollow>(nx, ny, opposite(to), cut.second, at.depth, passed,
                           is_nearer(parameters_, other, own));
  }
  if (kFollow && everything_) coverage_.count_group(GroupEnd::kLine);
}

template <bool kFollow>
void GeometricGolden::add_candidate(int x, int y, Direction to, int share, std::uint32_t depth,
                                    bool passed, bool nearer) {
  ++work_.candidates;
  if (kFollow && everything_) {
    candidates_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), to,
                           static_cast<std::uint8_t>(share), depth, passed});
  }
  if (!passed) return;
  ++work_.passed;
  const auto bx = static_cast<std::uint32_t>(x >> 2), by = static_cast<std::uint32_t>(y >> 2);
  if (kFollow) look_up_block(bx, by);
  touched_[by * static_cast<std::size_t>(layout_.block_columns()) + bx] = 1;
  Weights& weights = weights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x)];
  if (kFollow && everything_)
    coverage_.count_weight(parameters_.combine, nearer, weights, to, share);
  combine(parameters_.combine, nearer, weights, to, static_cast<std::uint8_t>(share));
}

template <bool kFollow>
bool GeometricGolden::is_dropped_early(int x, int y, int nx, int ny, Direction to,
                                       std::uint32_t depth) {
  const CoarseLayout::Tile own = CoarseLayout::tile_of(x, y), other = CoarseLayout::tile_of(nx, ny);
  const bool two = parameters_.depth_test == spec::geometric::DepthTest::kFarther && other != own;
  const std::uint16_t first = coarse_[coarse_layout_.index_of(own)];
  const std::uint16_t second = two ? coarse_[coarse_layout_.index_of(other)] : first;
  const std::uint16_t entry = std::min(first, second);
  const bool dropped = is_dropped(parameters_, depth, entry);
  if (!kFollow) return dropped;
  const LineOfPixels line = CoarseLayout::line_of(own);
  fetch_coarse(line);
  if (two && CoarseLayout::line_of(other) != line) fetch_coarse(CoarseLayout::line_of(other));
  if (!everything_) return dropped;
  if (dropped) coverage_.count_dropped(to);
  // Exactly at the limit: a depth that is smaller by 1 would be dropped.
  if (!dropped && depth > 0 && is_dropped(parameters_, depth - 1, entry))
    coverage_.count_coarse_equal();
  if (first != second)
    coverage_.count_two_tiles(first < second ? TwoTiles::kOwnLess : TwoTiles::kOtherLess);
  return dropped;
}

void GeometricGolden::fetch_coarse(const LineOfPixels& line) {
  std::uint64_t replaced = 0;
  if (coarse_cache_.look_up(line.u, line.v, replaced)) return;
  traffic_.read(Region::kCoarse).push_back(input_.bases.coarse + coarse_layout_.offset_of(line));
}

void GeometricGolden::count_test(const LineRecord& line, Direction to, std::uint32_t depth,
                                 std::uint32_t own, std::uint32_t other) {
  const bool seen = is_seen(parameters_, depth, own, other);
  if (parameters_.depth_test == spec::geometric::DepthTest::kFarther)
    coverage_.count_depth(own, other, seen);
  if (line.crease && seen && parameters_.crease_depth != 0)
    coverage_.count_crease(to, is_near_crease(parameters_, depth, own, other));
}

void GeometricGolden::fetch_depth(int x, int y, int nx, int ny) {
  const auto fetch = [&](const LineOfPixels& line) {
    std::uint64_t replaced = 0;
    const bool hit = depth_cache_.look_up(line.u, line.v, replaced);
    if (!hit) traffic_.read(Region::kDepth).push_back(input_.bases.depth + layout_.offset_of(line));
    count_fetch(CacheKind::kDepth, hit                                  ? Fetch::kHit
                                   : replaced == DirectMapped::kNothing ? Fetch::kMiss
                                                                        : Fetch::kReplaced);
  };
  const LineOfPixels own = layout_.line_of(x, y);
  fetch(own);
  if (parameters_.depth_test != spec::geometric::DepthTest::kFarther) return;
  const LineOfPixels other = layout_.line_of(nx, ny);
  if (other != own) fetch(other);
}

std::uint32_t GeometricGolden::block_address(std::uint32_t bx, std::uint32_t by) const {
  const std::uint32_t block = by * static_cast<std::uint32_t>(layout_.block_columns()) + bx;
  return input_.bases.weights + layout_.block_offset(block);
}

void GeometricGolden::look_up_block(std::uint32_t bx, std::uint32_t by) {
  std::uint64_t replaced = 0;
  if (block_cache_.look_up(bx, by, replaced)) {
    count_fetch(CacheKind::kBlock, Fetch::kHit);
    return;
  }
  const auto count = [&](Buffered outcome) {
    if (everything_ && !write_buffer_.empty()) coverage_.count_buffered(outcome);
  };
  if (replaced != DirectMapped::kNothing) {
    count_fetch(CacheKind::kBlock, Fetch::kReplaced);
    if (write_buffer_.exchange(DirectMapped::tag_of(bx, by), replaced)) {
      count(Buffered::kHit);
      return;
    }
    const std::uint64_t leaving = write_buffer_.push(replaced);
    count(leaving == WriteBuffer::kNothing ? Buffered::kEmptyPlace : Buffered::kLeaves);
    if (leaving != WriteBuffer::kNothing) write_block(leaving);
  }
  const std::size_t block = by * static_cast<std::size_t>(layout_.block_columns()) + bx;
  if (touched_[block] == 0) {
    count_fetch(CacheKind::kBlock, Fetch::kMiss);
    return;
  }
  count_fetch(CacheKind::kBlock, Fetch::kReadBack);
  const std::uint32_t address = block_address(bx, by);
  traffic_.read(Region::kWeights).push_back(address);
  if (bad(address)) forget_block(static_cast<int>(bx), static_cast<int>(by));
}

void GeometricGolden::write_block(std::uint64_t tag) {
  traffic_.write(Region::kWeights)
      .push_back(block_address(DirectMapped::u_of(tag), DirectMapped::v_of(tag)));
}

// Afterwards the resolve finds every block in the cache or in memory.
void GeometricGolden::empty_write_buffer() {
  const std::vector<std::uint64_t> blocks = write_buffer_.remaining();
  for (const std::uint64_t block : blocks) write_block(block);
  if (!everything_ || blocks.empty()) return;
  const bool full = blocks.size() == static_cast<std::size_t>(parameters_.write_buffer);
  coverage_.count_buffered(full ? Buffered::kEndFull : Buffered::kEndPart);
}

void GeometricGolden::forget_block(int bx, int by) {
  for (int y = 4 * by; y < std::min(4 * by + 4, height_); ++y) {
    const auto row = weights_.begin() + static_cast<std::ptrdiff_t>(y) * width_;
    std::fill(row + std::ptrdiff_t{4} * bx, row + std::min(4 * bx + 4, width_), Weights{});
  }
}

void GeometricGolden::resolve_block(int bx, int by) {
  ++work_.blocks;
  if (follow_ &&
      !block_cache_.holds(static_cast<std::uint32_t>(bx), static_cast<std::uint32_t>(by))) {
    const std::uint32_t address =
        block_address(static_cast<std::uint32_t>(bx), static_cast<std::uint32_t>(by));
    traffic_.read(Region::kWeights).push_back(address);
    if (bad(address)) forget_block(bx, by);
  }
  BlockRecord record;
  record.x = static_cast<std::uint16_t>(bx);
  record.y = static_cast<std::uint16_t>(by);
  LineSet read, written;
  for (int y = 4 * by; y < std::min(4 * by + 4, height_); ++y) {
    for (int x = 4 * bx; x < std::min(4 * bx + 4, width_); ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(x);
      const Weights& weights = weights_[i];
      if (!is_blended(weights)) continue;
      ++work_.blended_pixels;
      const Probe probe = probe_of(weights);
      const int dx = probe.left_right ? 1 : 0, dy = probe.left_right ? 0 : 1;
      const Rgba8& pixel = input_.image.at(x, y);
      // A neighbour without a weight may lie outside the frame; the pixel is used in its place.
      const Rgba8& first = probe.first != 0 ? input_.image.at(x - dx, y - dy) : pixel;
      const Rgba8& second = probe.second != 0 ? input_.image.at(x + dx, y + dy) : pixel;
      const Rgba8 blended = resolve(parameters_, probe, pixel, first, second);
      const LineOfPixels line = layout_.line_of(x, y);
      if (!bad(input_.bases.colour + layout_.offset_of(line))) pixels_[i] = blended;
      if (!follow_) continue;
      read.add(line);
      written.add(line);
      if (probe.first != 0) read.add(layout_.line_of(x - dx, y - dy));
      if (probe.second != 0) read.add(layout_.line_of(x + dx, y + dy));
      if (!everything_) continue;
      const std::size_t k = 4 * static_cast<std::size_t>(y & 3) + static_cast<std::size_t>(x & 3);
      record.weights[k] = weights;
      record.pixels[k] = blended;
      record.blended = static_cast<std::uint16_t>(record.blended | 1u << k);
      coverage_.count_probe(weights);
      if (probe.first != 0 && is_blended(weights_at(x - dx, y - dy))) {
        coverage_.count_original(probe.left_right ? Original::kLeft : Original::kAbove);
      } else {
        coverage_.count_original(Original::kNone);
      }
    }
  }
  if (!follow_) return;
  for (const LineOfPixels& line : read) read_colours(line);
  for (const LineOfPixels& line : written)
    traffic_.write(Region::kColour).push_back(input_.bases.colour + layout_.offset_of(line));
  if (!everything_) return;
  coverage_.count_block_lines(parameters_.layout, read.size());
  blocks_.push_back(record);
}

void GeometricGolden::read_colours(const LineOfPixels& line) {
  const bool copied = parameters_.frame_copy;
  const std::uint32_t offset = layout_.offset_of(line);
  if (parameters_.colour_lines > 0) {
    const bool full = kept_colours_.is_full();
    const bool hit = kept_colours_.look_up(offset / spec::geometric::kLineBytes);
    count_fetch(CacheKind::kColour, hit ? Fetch::kHit : full ? Fetch::kReplaced : Fetch::kMiss);
    if (hit) return;
  }
  traffic_.read(copied ? Region::kCopy : Region::kColour)
      .push_back((copied ? input_.bases.copy : input_.bases.colour) + offset);
}

void GeometricGolden::finish_traffic() {
  const Bases& bases = input_.bases;
  using spec::geometric::kFacesInLine, spec::geometric::kLineBytes;
  if (parameters_.select == spec::geometric::Select::kEdges) {
    Traffic::append_lines(traffic_.read(Region::kFaces), bases.facing,
                          lines_of(input_.facing.count, std::uint32_t{kFacesInLine}));
  }
  Traffic::append_lines(traffic_.read(Region::kEdges), bases.edges,
                        lines_of(static_cast<std::uint32_t>(input_.edges.size()), edges_in_line()));
  if (parameters_.frame_copy) {
    const std::uint32_t lines = layout_.bytes() / kLineBytes;
    Traffic::append_lines(traffic_.read(Region::kColour), bases.colour, lines);
    Traffic::append_lines(traffic_.write(Region::kCopy), bases.copy, lines);
  }
  if (!error_) return;
  for (const auto* lists : {&traffic_.reads, &traffic_.writes})
    for (const Traffic::List& list : *lists)
      memory_errors_ += static_cast<std::uint64_t>(std::count_if(list.begin(), list.end(), error_));
}

}  // namespace deburr::golden::geometric
