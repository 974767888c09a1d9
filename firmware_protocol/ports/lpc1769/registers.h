/// The LPC176x's registers as far as this port and TinyUSB's driver use them: names, addresses and bits of
/// NXP's user manual UM10360, whose chapter stands above each block. Written from knowledge of the part,
/// without that manual at hand; README.md says what has to be compared with it.
#ifndef GYROLOG_PORT_LPC1769_REGISTERS_H
#define GYROLOG_PORT_LPC1769_REGISTERS_H

#include <stddef.h>
#include <stdint.h>

// Chapter 6, table of interrupt sources.
typedef enum IRQn {
    NonMaskableInt_IRQn = -14,
    HardFault_IRQn = -13,
    MemoryManagement_IRQn = -12,
    BusFault_IRQn = -11,
    UsageFault_IRQn = -10,
    SVCall_IRQn = -5,
    DebugMonitor_IRQn = -4,
    PendSV_IRQn = -2,
    SysTick_IRQn = -1,
    TIMER2_IRQn = 3,
    USB_IRQn = 24,
    INTERRUPT_COUNT = 35
} IRQn_Type;

// Chapter 34: the core as NXP has built it.
#define __CM3_REV 0x0200U
#define __MPU_PRESENT 1U
#define __VTOR_PRESENT 1U
#define __NVIC_PRIO_BITS 5U
#define __Vendor_SysTickConfig 0U
#include <core_cm3.h>

#define BIT(n) (1UL << (n))

// Chapters 3 to 5: system control, clocking and power, flash accelerator.
typedef struct lpc_system_control {
    volatile uint32_t FLASHCFG;  // 000
    uint32_t reserved_004[31];
    volatile uint32_t PLL0CON;  // 080
    volatile uint32_t PLL0CFG;
    volatile uint32_t PLL0STAT;
    volatile uint32_t PLL0FEED;
    uint32_t reserved_090[4];
    volatile uint32_t PLL1CON;  // 0A0
    volatile uint32_t PLL1CFG;
    volatile uint32_t PLL1STAT;
    volatile uint32_t PLL1FEED;
    uint32_t reserved_0b0[4];
    volatile uint32_t PCON;  // 0C0
    volatile uint32_t PCONP;
    uint32_t reserved_0c8[15];
    volatile uint32_t CCLKCFG;  // 104
    volatile uint32_t USBCLKCFG;
    volatile uint32_t CLKSRCSEL;
    uint32_t reserved_110[28];
    volatile uint32_t RSID;  // 180
    uint32_t reserved_184[7];
    volatile uint32_t SCS;  // 1A0
    uint32_t reserved_1a4;
    volatile uint32_t PCLKSEL0;
    volatile uint32_t PCLKSEL1;
} lpc_system_control;
_Static_assert(offsetof(lpc_system_control, PLL1CON) == 0x0A0, "UM10360, 4.6");
_Static_assert(offsetof(lpc_system_control, CCLKCFG) == 0x104, "UM10360, 4.7");
_Static_assert(offsetof(lpc_system_control, RSID) == 0x180, "UM10360, 3.4");
_Static_assert(offsetof(lpc_system_control, PCLKSEL1) == 0x1AC, "UM10360, 4.7");
#define SYSTEM ((lpc_system_control*)0x400FC000U)

#define FLASHCFG_FLASHTIM_MASK (0xFUL << 12U)
#define FLASHCFG_FLASHTIM(clocks) (((clocks)-1UL) << 12U)
#define PLLCON_ENABLE BIT(0)
#define PLLCON_CONNECT BIT(1)
#define PLL0CFG_M(m) ((m)-1UL)
#define PLL0CFG_N(n) (((n)-1UL) << 16U)
#define PLL0STAT_ENABLED BIT(24)
#define PLL0STAT_CONNECTED BIT(25)
#define PLL0STAT_LOCKED BIT(26)
#define PLL1CFG_M(m) ((m)-1UL)
#define PLL1CFG_P_IS_2 (1UL << 5U)
#define PLL1STAT_ENABLED BIT(8)
#define PLL1STAT_CONNECTED BIT(9)
#define PLL1STAT_LOCKED BIT(10)
#define PLLFEED_FIRST 0xAAU
#define PLLFEED_SECOND 0x55U
#define PCONP_SSP1 BIT(10)
#define PCONP_GPIO BIT(15)
#define PCONP_TIM2 BIT(22)
#define PCONP_USB BIT(31)
#define CCLKCFG_DIVIDE(by) ((by)-1UL)
#define CLKSRCSEL_MAIN_OSCILLATOR 1UL
#define RSID_POR BIT(0)
#define RSID_EXTR BIT(1)
#define RSID_WDTR BIT(2)
#define RSID_BODR BIT(3)
#define SCS_OSCEN BIT(5)
#define SCS_OSCSTAT BIT(6)
#define PCLKSEL0_SSP1_IS_CCLK (1UL << 20U)
#define PCLKSEL1_TIMER2_IS_CCLK (1UL << 12U)

// Chapter 8: pin connect block. Two bits a pin, sixteen pins a register.
typedef struct lpc_pin_connect {
    volatile uint32_t PINSEL[11];
    uint32_t reserved_02c[5];
    volatile uint32_t PINMODE[10];
} lpc_pin_connect;
_Static_assert(offsetof(lpc_pin_connect, PINMODE) == 0x40, "UM10360, 8.5");
#define PIN_CONNECT ((lpc_pin_connect*)0x4002C000U)
#define PINMODE_PULL_UP 0U
#define PINMODE_NEITHER 2U
#define PINMODE_PULL_DOWN 3U

// Chapter 9: GPIO, one block a port.
typedef struct lpc_gpio {
    volatile uint32_t FIODIR;
    uint32_t reserved_04[3];
    volatile uint32_t FIOMASK;
    volatile uint32_t FIOPIN;
    volatile uint32_t FIOSET;
    volatile uint32_t FIOCLR;
} lpc_gpio;
_Static_assert(sizeof(lpc_gpio) == 0x20, "UM10360, 9.5");
#define GPIO_PORT(n) ((lpc_gpio*)(0x2009C000U + 0x20U * (n)))

// Chapter 18: SSP.
typedef struct lpc_ssp {
    volatile uint32_t CR0;
    volatile uint32_t CR1;
    volatile uint32_t DR;
    volatile uint32_t SR;
    volatile uint32_t CPSR;
} lpc_ssp;
#define SSP1 ((lpc_ssp*)0x40030000U)
#define SSP_CR0_BITS(n) ((n)-1UL)
#define SSP_CR0_CPOL BIT(6)
#define SSP_CR0_CPHA BIT(7)
#define SSP_CR0_RATE(divisor) (((divisor)-1UL) << 8U)
#define SSP_CR1_ENABLE BIT(1)
#define SSP_SR_TNF BIT(1)  // transmit FIFO not full
#define SSP_SR_RNE BIT(2)  // receive FIFO not empty

// Chapter 21: timers.
typedef struct lpc_timer {
    volatile uint32_t IR;
    volatile uint32_t TCR;
    volatile uint32_t TC;
    volatile uint32_t PR;
    volatile uint32_t PC;
    volatile uint32_t MCR;
    volatile uint32_t MR[4];
    volatile uint32_t CCR;  // 28
    volatile uint32_t CR[2];
    uint32_t reserved_34[2];
    volatile uint32_t EMR;  // 3C
    uint32_t reserved_40[12];
    volatile uint32_t CTCR;  // 70
} lpc_timer;
_Static_assert(offsetof(lpc_timer, CR) == 0x2C, "UM10360, 21.6");
_Static_assert(offsetof(lpc_timer, CTCR) == 0x70, "UM10360, 21.6");
#define TIMER2 ((lpc_timer*)0x40090000U)
#define TIMER_IR_CR0 BIT(4)
#define TIMER_TCR_ENABLE BIT(0)
#define TIMER_TCR_RESET BIT(1)
#define TIMER_CCR_CAP0_RISING BIT(0)
#define TIMER_CCR_CAP0_INTERRUPT BIT(2)

// Chapter 28: watchdog.
typedef struct lpc_watchdog {
    volatile uint32_t WDMOD;
    volatile uint32_t WDTC;
    volatile uint32_t WDFEED;
    volatile uint32_t WDTV;
    volatile uint32_t WDCLKSEL;
} lpc_watchdog;
#define WATCHDOG ((lpc_watchdog*)0x40000000U)
#define WDMOD_WDEN BIT(0)
#define WDMOD_WDRESET BIT(1)
#define WDCLKSEL_INTERNAL_RC 0UL

// Chapter 32: in-application programming. Commands and results are words in memory; the ROM uses the last 32
// bytes of the first memory.
#define IAP_READ_SERIAL_NUMBER 58U
#define IAP_SUCCESS 0U
typedef void (*iap_function)(uint32_t command[5], uint32_t result[5]);
#define IAP ((iap_function)0x1FFF1FF1U)

// Chapter 11: USB device controller. TinyUSB's driver knows these names.
typedef struct lpc_usb {
    volatile uint32_t DevIntSt;  // 200
    volatile uint32_t DevIntEn;
    volatile uint32_t DevIntClr;
    volatile uint32_t DevIntSet;
    volatile uint32_t CmdCode;  // 210
    volatile uint32_t CmdData;
    volatile uint32_t RxData;
    volatile uint32_t TxData;
    volatile uint32_t RxPLen;
    volatile uint32_t TxPLen;
    volatile uint32_t Ctrl;
    volatile uint32_t DevIntPri;
    volatile uint32_t EpIntSt;  // 230
    volatile uint32_t EpIntEn;
    volatile uint32_t EpIntClr;
    volatile uint32_t EpIntSet;
    volatile uint32_t EpIntPri;
    volatile uint32_t ReEp;
    volatile uint32_t EpInd;
    volatile uint32_t MaxPSize;
    volatile uint32_t DMARSt;  // 250
    volatile uint32_t DMARClr;
    volatile uint32_t DMARSet;
    uint32_t reserved_25c[9];
    volatile uint32_t UDCAH;  // 280
    volatile uint32_t EpDMASt;
    volatile uint32_t EpDMAEn;
    volatile uint32_t EpDMADis;
    volatile uint32_t DMAIntSt;
    volatile uint32_t DMAIntEn;
    uint32_t reserved_298[2];
    volatile uint32_t EoTIntSt;  // 2A0
    volatile uint32_t EoTIntClr;
    volatile uint32_t EoTIntSet;
    volatile uint32_t NDDRIntSt;
    volatile uint32_t NDDRIntClr;
    volatile uint32_t NDDRIntSet;
    volatile uint32_t SysErrIntSt;
    volatile uint32_t SysErrIntClr;
    volatile uint32_t SysErrIntSet;
    uint32_t reserved_2c4[844];
    volatile uint32_t USBClkCtrl;  // FF4
    volatile uint32_t USBClkSt;
} lpc_usb;
#define USB_BLOCK_BEGIN 0x200U
_Static_assert(offsetof(lpc_usb, DMARSt) == 0x250 - USB_BLOCK_BEGIN, "UM10360, 11.10");
_Static_assert(offsetof(lpc_usb, UDCAH) == 0x280 - USB_BLOCK_BEGIN, "UM10360, 11.10");
_Static_assert(offsetof(lpc_usb, EoTIntSt) == 0x2A0 - USB_BLOCK_BEGIN, "UM10360, 11.10");
_Static_assert(offsetof(lpc_usb, USBClkCtrl) == 0xFF4 - USB_BLOCK_BEGIN, "UM10360, 11.10");
#define LPC_USB ((lpc_usb*)(0x5000C000U + USB_BLOCK_BEGIN))
#define USBCLK_DEVICE BIT(1)
#define USBCLK_AHB BIT(4)

#endif
