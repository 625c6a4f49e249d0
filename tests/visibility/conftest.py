from support.spoiled import spoiled

__all__ = ["spoiled"]
