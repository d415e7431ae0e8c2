/* The compiled part: the impact of many scenes in doubles (impacts.h).

   Every operation is the IEEE one, rounded by itself: the file must be compiled with
   -ffp-contract=off. No Python here: the functions are called through ctypes, which releases the
   interpreter's lock. */

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef _MSC_VER
#define restrict __restrict
#endif
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* One text, compiled for several instruction sets, chosen when the library is loaded; for one where
   the sanitizers look on, which takes a third of the time. */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
#ifndef __SANITIZE_ADDRESS__
#define SEVERAL_SETS
#endif
#endif
#ifdef SEVERAL_SETS
#define CLONES __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define CLONES
#endif

#if defined(__GNUC__) && !defined(__clang__)
#define INDEPENDENT _Pragma("GCC ivdep")
#elif defined(__clang__)
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT __pragma(loop(ivdep))
#endif

/* Loops become vectors as with -O3, whose other passes would take half as long again and gain nothing. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("tree-vectorize", "vect-cost-model=dynamic")
#endif

/* Every scene of a strip; in any order, where it is `EACH`. */
#define LOOP for (int64_t i = 0; i < lanes; i++)
#define EACH INDEPENDENT LOOP

#include "impacts.h"

EXPORT const char *instructions(void)
{
#ifdef SEVERAL_SETS
    if (__builtin_cpu_supports("x86-64-v4")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    return "SSE2";
#else
    return "baseline";
#endif
}

/* setuptools exports this name from every extension; nobody imports this one. */
EXPORT void *PyInit__machine(void) { return 0; }
