/* The runs of firmware_run.c in the flash of a board. */
    .section .rodata
    .global firmware_runs
    .balign 8
firmware_runs:
    .incbin "runs.bin"
