"""A page in the browser to talk to the robot, watch it and teach it: `python -m dcg_torch.talk`.

`host` owns the conversation and runs it in a thread of its own; `page` shows it to every visitor.
"""
