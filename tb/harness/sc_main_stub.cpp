// SPDX-License-Identifier: MIT
// SystemC's library has a main() that calls sc_main(). Programs here have their own main()
// (GoogleTest, Google Benchmark, the command) and start the kernel with ClockDomain::run(), so
// sc_main() is never called, but the library's reference must be resolved. Declared here because
// SystemC's headers are slow to compile.
extern "C" int sc_main(int, char**) { return 1; }
