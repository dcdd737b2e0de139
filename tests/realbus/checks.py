"""What the scripts of this folder say to the tests that run them: one line for each check."""


def check(name, got, expected):
    if got == expected:
        print(f"ok {name}", flush=True)
    else:
        print(f"FAIL {name}: {got} instead of {expected}", flush=True)

