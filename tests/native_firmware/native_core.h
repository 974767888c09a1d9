/* What CMSIS takes from the compiler for an Arm core, for the machine that runs the tests. Forced into each
   unit of the firmware ahead of CMSIS, whose own file for the compiler is then left out. */
#ifndef GYROLOG_NATIVE_CORE_H
#define GYROLOG_NATIVE_CORE_H

#include <stdint.h>

#define __CMSIS_COMPILER_H
#define __CMSIS_GCC_H
#define __ASM __asm__
#define __INLINE inline
#define __STATIC_INLINE static inline
#define __STATIC_FORCEINLINE static inline
#define __NO_RETURN __attribute__((noreturn))
#define __USED __attribute__((used))
#define __WEAK __attribute__((weak))
#define __PACKED __attribute__((packed))
#define __PACKED_STRUCT struct __attribute__((packed))
#define __PACKED_UNION union __attribute__((packed))
#define __ALIGNED(bytes) __attribute__((aligned(bytes)))
#define __RESTRICT restrict
#define __COMPILER_BARRIER() __asm__ volatile("" ::: "memory")
#define __DSB() __COMPILER_BARRIER()
#define __ISB() __COMPILER_BARRIER()
#define __DMB() __COMPILER_BARRIER()
#define __NOP() __COMPILER_BARRIER()
#define __CLZ(value) ((value) == 0U ? 32U : (uint32_t)__builtin_clz(value))

#endif
