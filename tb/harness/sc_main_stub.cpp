// SPDX-License-Identifier: MIT
// SystemC's library brings a main() that calls sc_main(). Programs here have their own main
// (GoogleTest, Google Benchmark, the command) and start the kernel with ClockDomain::run(), so
// sc_main is never called; the library's reference to it must still be resolved.
// Declared as SystemC does, whose headers take a second to read.
extern "C" int sc_main(int, char**) { return 1; }
