#include "kernel/base/tables/text_table.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

// What is a number for one function is one for the other, as far as 64 bits reach.
void fuzz_one(std::string_view bytes) {
  for (const TextRow& row : read_text_table(bytes).rows)
    for (const std::string_view word : row.words)
      for (const int digits : {0, 9})
        if (parse_scaled_integer(word, digits) && !parse_number(word)) std::abort();
}
