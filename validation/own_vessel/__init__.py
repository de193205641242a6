NAMES = ("flows",)
