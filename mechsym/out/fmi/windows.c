/* What a library needs on Windows when it is linked with nothing but what Windows itself has. */

/* the first call, for which there is nothing to prepare */
int DllMainCRTStartup(void *library, unsigned long reason, void *reserved) { return 1; }

/* a function with more than a page of its own calls this first, the size in rax: it touches the stack page by page, since
   Windows grows it by one page at a time */
__asm__(".globl ___chkstk_ms\n"
        "___chkstk_ms:\n"
        "  pushq %rcx\n"
        "  pushq %rax\n"
        "  leaq 24(%rsp), %rcx\n"
        "1:\n"
        "  cmpq $4096, %rax\n"
        "  jb 2f\n"
        "  subq $4096, %rcx\n"
        "  orq $0, (%rcx)\n"
        "  subq $4096, %rax\n"
        "  jmp 1b\n"
        "2:\n"
        "  subq %rax, %rcx\n"
        "  orq $0, (%rcx)\n"
        "  popq %rax\n"
        "  popq %rcx\n"
        "  ret\n");
