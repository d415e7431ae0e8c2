"""The Apple II Plus: Applesoft's arithmetic and text (`applesoft`), any program (`emulator`).

It knows nothing of collisions. `captured` reads what a real ROM did, in `golden/`.
"""
