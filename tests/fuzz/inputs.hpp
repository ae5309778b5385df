// What is done with an input that may be anything: it is taken, or refused with one clear line. All else ends
// the process. The fuzzers make inputs, corpus_test has those that were worth keeping.
#pragma once

#include <string_view>

namespace carom::fuzz {

void take_scene(std::string_view bytes);       ///< read, written, read again; small ones become a World
void take_xyz(std::string_view bytes);         ///< read, written, read again
void take_lammps(std::string_view bytes);      ///< a data file, read
void take_checkpoint(std::string_view bytes);  ///< as it is, and with marks, scene and checksum put right

}  // namespace carom::fuzz
