// SPDX-License-Identifier: MIT
#include <array>

#include "tb/results/result.h"

namespace deburr::tb {
namespace {

constexpr std::array kStatistics = {
    Statistic{"schema", "", "Version of this file's layout."},
    Statistic{"unit", "", "The engine that ran."},
    Statistic{"verdict", "", "pass, fail, or unchecked when no golden model ran beside it."},
    Statistic{"reason", "", "Why the run failed or is not complete."},
    Statistic{"interrupted", "", "The run was ended by a signal; counters cover what was done."},
    Statistic{"checks.comparisons", "value", "Outputs compared with the golden model."},
    Statistic{"checks.mismatches", "value", "Outputs that differ from the golden model."},
    Statistic{"checks.traffic_comparisons", "line",
              "Memory accesses compared with the golden model's prediction, in order."},
    Statistic{"checks.traffic_mismatches", "line",
              "Memory accesses that differ from the prediction."},
    Statistic{"cycles", "clk", "From the end of reset to the last output."},
    Statistic{"clock_mhz", "MHz", "Clock that rates and times are quoted for."},
    Statistic{"throughput.value", "see throughput.unit", "Work over cycles of the whole run."},
    Statistic{"throughput.unit", "", "Unit of the rate."},
    Statistic{"throughput.bound", "see throughput.unit", "What the hardware could do at best."},
    Statistic{"throughput.bound_meaning", "", "Where the bound comes from."},
    Statistic{"latency.unit", "", "Unit of the latencies."},
    Statistic{"latency.min", "clk", "Shortest latency of a transaction, input taken to output."},
    Statistic{"latency.p50", "clk", "Half of all transactions are at most this slow."},
    Statistic{"latency.p95", "clk", "95 % of all transactions are at most this slow."},
    Statistic{"latency.p99", "clk", "99 % of all transactions are at most this slow."},
    Statistic{"latency.max", "clk", "Longest latency of a transaction."},
    Statistic{"latency.histogram", "clk, transactions",
              "Bins: transactions with a latency of at least `from` and below the next bin's."},
    Statistic{"memory.bytes_read", "byte", "Bytes read from memory."},
    Statistic{"memory.bytes_written", "byte", "Bytes written to memory."},
    Statistic{"memory.lines_filled", "line",
              "Reads of memory: lines of the cache, or of the frame where it waits in memory."},
    Statistic{"units.*.busy", "clk",
              "Cycles in which the unit did work, on one lane at least, or had some under way."},
    Statistic{"units.*.idle", "clk",
              "Cycles in which the unit had nothing to do, or only waited for answers of memory."},
    Statistic{"units.*.stalls.*", "clk",
              "Cycles in which the unit had work and could do none of it."},
    Statistic{"bottleneck.unit", "", "The unit that held the run back most."},
    Statistic{"bottleneck.cause", "", "Its stall cause, or busy where it worked all the time."},
    Statistic{"bottleneck.cycles", "clk", "Cycles of that unit that went there."},
    Statistic{"bottleneck.meaning", "", "What the cause means."},
    Statistic{"sram_bits.*", "bit", "Size of a memory of the model, as built."},
    Statistic{"sram_bits_at_frame_width.*", "bit",
              "The same if it were built for the width of this frame."},
    Statistic{"sram_ports.*", "", "Its ports: reads and writes in a clock."},
    Statistic{"figures", "", "Keys of this file that a reader looks for first."},
    Statistic{"quality.reference", "", "What the picture is compared with."},
    Statistic{"quality.psnr_db", "dB", "PSNR over the frame; inf: identical."},
    Statistic{"quality.psnr_edge_db", "dB",
              "PSNR over edge pixels: truth and unfiltered input differ by more than 2/255."},
    Statistic{"quality.psnr_silhouette_db", "dB",
              "PSNR over edge pixels with a relative depth step of 5 % to a neighbour."},
    Statistic{"quality.psnr_before_db", "dB", "The same of the picture that went in."},
    Statistic{"quality.psnr_edge_before_db", "dB", "The same of the picture that went in."},
    Statistic{"quality.psnr_silhouette_before_db", "dB", "The same of the picture that went in."},
    Statistic{"host.seconds", "s", "Time of the simulation on this host, set-up not included."},
    Statistic{"host.cpu_seconds", "s",
              "The same as time of the processor: not that of other programs."},
    Statistic{"host.mcycles_per_s", "Mcycle/s", "Simulated cycles a second of host time."},
};

}  // namespace

std::span<const Statistic> statistics() { return kStatistics; }

}  // namespace deburr::tb
