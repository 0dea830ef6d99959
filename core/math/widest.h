// Functions that are compiled twice, for SSE2 and AVX2, and chosen when the program is loaded.
#pragma once

// Sanitizers cannot do with functions that are chosen while the program is loaded. No clone may
// multiply and add in one: recordings are to be the same on all machines.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LIMPID_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define LIMPID_WIDE
#endif
